// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chart_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "chart_sample.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "joined_team.h"
#include "name_list.h"
#include "options.h"
#include "simulate_options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/specimen_reader.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Writes chart.svg, chart.png, chart.csv and chart.json into the folder. Stop when you like: the same
command goes on from there. Errors are relative to each pixel of the reference (down to a tenth of
the mean), root mean square; the reference is Monte Carlo with a third of the finest accuracy, on
pixels spread evenly over the image.

Under mpirun processes share the reference and the images that models learn from; one of them times the
points, while the others wait.

Of a folder that 'semsurf sample' made, registration and reconstruction are charted instead: how far off
a start may be, and error against time. Files are registration.csv, .svg, .png, reconstruction.csv,
.svg, .png and chart.json.

Examples:
  semsurf chart samples/mesa80.toml -o mesa-chart
  semsurf chart samples/flat.toml --quick -o flat-chart
  semsurf chart scan.gwy --material Si --pixel-size 3nm --methods replay,accuracy,facet-network -o chart
  semsurf chart cube.stl --substrate Si --tilt 40 --accuracy 2% -o cube-chart
  semsurf sample pads -o pads && semsurf chart pads --model samples/si-1keV-10nm.json -o pads-chart)";

struct Options {
  BoundParameters scene;
  ChartSampleOptions sample;
  std::optional<std::string> output, accuracy, reference, compared, most, surfaces, surface_px, seed, threads, methods;
  bool quick = false, quiet = false;
};

workflow::ChartJob make_job(const Options& o, const std::string& command_line) {
  workflow::ChartJob job;
  if (o.accuracy) job.finest = parse_share(*o.accuracy, "--accuracy");
  if (o.reference) job.reference_accuracy = parse_share(*o.reference, "--reference");
  if (o.compared) job.compared_pixels = static_cast<int>(parse_whole(*o.compared, "--compared", 16, 1 << 24));
  if (o.most) job.most_primaries = static_cast<double>(parse_whole(*o.most, "--most", 100'000, std::int64_t{1} << 50));
  if (o.surfaces) job.surfaces = static_cast<int>(parse_whole(*o.surfaces, "--surfaces", 2, 10000));
  if (o.surface_px) job.surface_px = static_cast<int>(parse_whole(*o.surface_px, "--surface-size", 16, 4096));
  if (o.seed) job.seed = parse_seed(*o.seed, "--seed");
  if (o.methods) job.families = parse_names(*o.methods);
  job.threads = parse_threads(o.threads);
  job.quick = o.quick;
  if (!o.output) throw UsageError("--output", "no folder is given", "Add -o chart");
  job.folder = *o.output;
  job.command_line = command_line;
  job.scene = read_scene(o.scene.given(), o.quiet, workflow::specimen_reader(nullptr, processes_here()));
  return job;
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string errors_of(const workflow::ChartPoint& p) {
  std::string text;
  for (const workflow::ChartChannel& c : p.channels) text += fmt::format("  {} {:>7}", c.name, percent(c.error.rms));
  return text;
}

std::string time_text(double seconds) {
  return seconds >= 0.995 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.3g} ms", 1e3 * seconds);
}

void print_point(const workflow::ChartPoint& p) {
  print("{:<24} {:<38} {:>8} + {:<8}{}\n", p.family, p.setting, time_text(p.run_s), time_text(p.preparation_s),
             errors_of(p));
}

void print_choices(const workflow::ChartSummary& s) {
  for (const workflow::ChartChoice& c : s.choices) {
    std::string text = c.reason;
    if (c.id.empty()) text += "; it is not on the chart";
    else if (c.fastest.empty()) text += "; no method on the chart met it";
    else
      text += fmt::format("; {}, {:.2f} times as long as the fastest that does, {}", c.met ? "met" : "NOT met", c.ratio,
                          c.fastest);
    print("{:<15} {}\n", fmt::format("--accuracy {}", format_share(c.accuracy)), text);
  }
}

// Options of scenes say nothing of samples, and the other way round.
void check_options(const CLI::App& app, bool sample) {
  constexpr std::array of_both{"--output", "--methods", "--quick", "--seed", "--threads", "--quiet"};
  constexpr std::array of_samples{"--draws", "--model"};
  const auto is_in = [](const auto& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || option->get_positional() || is_in(of_both, name)) continue;
    if (is_in(of_samples, name) == sample) continue;
    throw UsageError(name, sample ? "it says nothing of a folder that 'semsurf sample' made"
                                  : "it is for a folder that 'semsurf sample' made",
                     "Leave it out");
  }
}

bool is_folder(const Options& o) {
  std::error_code ignored;
  const auto inputs = o.scene.given().find("specimen.input");
  return inputs != o.scene.given().end() && inputs->second.size() == 1 &&
         std::filesystem::is_directory(inputs->second.front(), ignored);
}

int chart_folder(const Options& o, const std::string& command_line) {
  if (leave_to_leader("chart FOLDER")) return 0;
  ChartSampleOptions sample = o.sample;
  sample.sample = o.scene.given().at("specimen.input").front();
  sample.output = o.output;
  sample.methods = o.methods;
  sample.seed = o.seed;
  sample.threads = o.threads;
  sample.quick = o.quick;
  sample.quiet = o.quiet;
  return chart_sample(sample, command_line);
}

int chart(const Options& o, const std::string& command_line) {
  workflow::ChartJob job;
  workflow::together(team(), [&] { job = make_job(o, command_line); });
  workflow::ChartSummary s;
  {
    JobReporter reporter(o.quiet);
    bool headed = false;
    const auto tell = [&](const workflow::ChartPoint& p) {
      if (o.quiet) return;
      reporter.clear();
      if (!headed) print("{:<24} {:<38} {:>8} + {:<8}  rms errors\n", "method", "setting", "image", "before it");
      headed = true;
      print_point(p);
      flush();
    };
    s = workflow::run(job, reporter, tell, team());
  }
  if (!workflow::leads(team())) return 0;
  if (!s.complete) {
    print_note(fmt::format("stopped: what is done is kept in {}; the same command goes on from there", job.folder.string()));
    return exit_interrupted;
  }
  if (o.quiet) return 0;
  if (s.found > 0) print("{} points were there before\n", s.found);
  for (const std::string& text : s.left_out) print("left out: {}\n", text);
  std::string floor;
  for (const workflow::ChartChannel& c : s.reference)
    floor += fmt::format("{}{} {}", floor.empty() ? "" : ", ", c.name, percent(c.error.reference_noise));
  print("reference: {} pixels, its noise {}\n", s.compared, floor);
  print_choices(s);
  for (const auto& path : s.written) print("written {}\n", path.string());
  return 0;
}

void add_options(CLI::App& app, Options& o) {
  const char* group = "Chart";
  app.add_option("-o,--output", o.output, "Folder for the chart and what it is made from")->type_name("FOLDER")->group(group);
  app.add_flag("--quick", o.quick, "Few settings of each method, a finest accuracy of 3%, small trainings")->group(group);
  std::string families = "Methods to chart, of those below, with commas between them (all)";
  app.add_option("--methods", o.methods, families)->type_name("NAME,...")->group(group);
  app.add_option("--accuracy", o.accuracy, "Finest accuracy that methods are asked for, 0.1% to 10% (1%)")->type_name("SHARE")->group(group);
  app.add_option("--reference", o.reference, "Accuracy of the reference (a third of the finest)")->type_name("SHARE")->group(group);
  app.add_option("--compared", o.compared, "Number of pixels of the reference, about (1000)")->type_name("N")->group(group);
  app.add_option("--most", o.most, "Primaries in the whole image above which settings are left out, direct\n"
                                   "ones with more than a twentieth of it (3e8; with --quick 5e6)")->type_name("N")->group(group);
  app.add_option("--surfaces", o.surfaces, "Surfaces that fast models learn on (20)")->type_name("N")->group(group);
  app.add_option("--surface-size", o.surface_px, "Pixels across each of those surfaces (64)")->type_name("N")->group(group);
  app.add_option("--seed", o.seed, "Seed of the random numbers: the same seed gives the same numbers, but for times (1)")->type_name("N")->group(group);
  add_threads_option(app, o.threads)->group(group);
  add_quiet_flag(app, o.quiet)->group(group);
}

std::string footer() {
  std::string text = "Methods for scenes (--methods):\n";
  for (const workflow::ChartFamily& f : workflow::chart_families()) text += fmt::format("  {:<24}{}\n", f.name, f.what);
  text += "\nMethods for folders of 'semsurf sample':\n" + chart_sample_methods();
  return text + "\n" + examples;
}

}  // namespace

void add_chart(CLI::App& app, Action& action, const std::string& command_line) {
  const auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("chart", "Time against error of every method, on a scene or a sample of yours");
  add_request_options(*sub, options->scene,
                      {"beam.energy", "beam.tilt", "beam.azimuth", "beam.spot", "beam.convergence", "beam.focus",
                       "beam.working_distance", "scan.size", "scan.pixel_size", "scan.region", "simulation.physics",
                       "simulation.cutoff"});
  add_options(*sub, *options);
  add_chart_sample_options(*sub, options->sample);
  sub->footer(footer());
  sub->callback([options, sub, &action, command_line] {
    action = [options, sub, command_line] {
      const bool folder = is_folder(*options);
      if (!folder) check_options(*sub, false);
      else if (workflow::is_sample(options->scene.given().at("specimen.input").front())) check_options(*sub, true);
      return folder ? chart_folder(*options, command_line) : chart(*options, command_line);
    };
  });
}

}  // namespace surf::cli
