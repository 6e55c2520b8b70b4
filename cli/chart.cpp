// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chart_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "chart_sample.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "joined_team.h"
#include "simulate_options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/specimen_reader.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* chart_examples =
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

struct ChartArguments {
  BoundParameters scene, bound;  // of both kinds of charts
  bool quiet = false;
};

workflow::ChartJob chart_job_of(const ChartArguments& o, const std::string& command_line) {
  workflow::ChartJob job;
  o.bound.apply(job);
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=chart`");
  job.command_line = command_line;
  job.scene =
      read_scene(o.scene.given(), o.quiet, workflow::specimen_reader(nullptr, processes_here()));
  return job;
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string errors_of(const workflow::ChartPoint& p) {
  std::string text;
  for (const workflow::ChartChannel& c : p.channels)
    text += fmt::format("  {} {:>7}", c.name, percent(c.error.rms));
  return text;
}

void print_point(const workflow::ChartPoint& p) {
  print("{:<24} {:<38} {:>8} + {:<8}{}\n", p.family, p.setting, time_text(p.run_s),
        time_text(p.preparation_s), errors_of(p));
}

void print_choices(const workflow::ChartSummary& s) {
  for (const workflow::ChartChoice& c : s.choices) {
    std::string text = c.reason;
    if (c.id.empty()) text += "; it is not on the chart";
    else if (c.fastest.empty()) text += "; no method on the chart met it";
    else
      text += fmt::format("; {}, {:.2f} times as long as the fastest that does, {}",
                          c.met ? "met" : "NOT met", c.ratio, c.fastest);
    print("{:<15} {}\n", fmt::format("--accuracy {}", format_share(c.accuracy)), text);
  }
}

/// What is of scenes says nothing of samples, and the other way round.
void refuse_other_kind(const ChartArguments& o, bool sample) {
  std::set<std::string> own{"specimen.input"};
  const auto keep = [&](const Parameter& about, Field&) { own.insert(about.name); };
  workflow::ChartJob chart;
  workflow::ChainChartJob chain;
  if (sample) for_each_parameter(chain, keep);
  else for_each_parameter(chart, keep);
  const auto refuse = [&](const GivenTexts& given) {
    for (const auto& [name, texts] : given)
      if (!own.contains(name))
        throw UsageError(fmt::format("`{}`", name),
                         sample ? "it says nothing of a folder that 'semsurf sample' made"
                                : "it is for a folder that 'semsurf sample' made",
                         "Leave it out");
  };
  refuse(o.bound.given());
  if (sample) refuse(o.scene.given());
}

bool is_folder(const ChartArguments& o) {
  std::error_code ignored;
  const auto inputs = o.scene.given().find("specimen.input");
  return inputs != o.scene.given().end() && inputs->second.size() == 1 &&
         std::filesystem::is_directory(inputs->second.front(), ignored);
}

int chart_folder(const ChartArguments& o, const std::string& command_line) {
  if (leave_to_leader("chart FOLDER")) return 0;
  workflow::ChainChartJob job;
  o.bound.apply(job);
  job.sample = o.scene.given().at("specimen.input").front();
  job.command_line = command_line;
  return chart_sample(std::move(job), o.quiet);
}

int chart(const ChartArguments& o, const std::string& command_line) {
  workflow::ChartJob job;
  workflow::together(team(), [&] { job = chart_job_of(o, command_line); });
  workflow::ChartSummary s;
  {
    JobReporter reporter(o.quiet);
    bool headed = false;
    const auto tell = [&](const workflow::ChartPoint& p) {
      if (o.quiet) return;
      reporter.clear();
      if (!headed)
        print("{:<24} {:<38} {:>8} + {:<8}  rms errors\n", "method", "setting", "image",
              "before it");
      headed = true;
      print_point(p);
      flush();
    };
    s = workflow::run(job, reporter, tell, team());
  }
  if (!workflow::leads(team())) return 0;
  if (!s.complete) {
    print_note(
        fmt::format("stopped: what is done is kept in {}; the same command goes on from there",
                    job.folder.string()));
    return exit_interrupted;
  }
  if (o.quiet) return 0;
  if (s.found > 0) print("{} points were there before\n", s.found);
  for (const std::string& text : s.left_out) print("left out: {}\n", text);
  std::string floor;
  for (const workflow::ChartChannel& c : s.reference)
    floor +=
        fmt::format("{}{} {}", floor.empty() ? "" : ", ", c.name, percent(c.error.reference_noise));
  print("reference: {} pixels, its noise {}\n", s.compared, floor);
  print_choices(s);
  for (const auto& path : s.written) print("written {}\n", path.string());
  return 0;
}

void add_options(CLI::App& app, ChartArguments& o) {
  // How much is simulated, by which method and on which mesh, is what the chart compares.
  add_request_options(app, o.scene,
                      {"beam.current", "beam.dwell", "simulation.electrons", "simulation.accuracy",
                       "simulation.accuracy_floor", "simulation.time", "simulation.method",
                       "simulation.mesh_tolerance", "simulation.detectors", "simulation.seed"});
  o.bound.looks["output"] = {.name = "-o,--output"};
  o.bound.add<workflow::ChartJob>(app, "Chart");
  add_quiet_flag(app, o.quiet)->group("Chart");
  o.bound.add<workflow::ChainChartJob>(app, "Chart of a sample", {},
                                       {"chart.draws", "chart.model"});
}

std::string footer() {
  std::string text = "Methods for scenes (--methods):\n";
  for (const workflow::ChartFamily& f : workflow::chart_families())
    text += fmt::format("  {:<24}{}\n", f.name, f.what);
  text += "\nMethods for folders of 'semsurf sample':\n" + chart_sample_methods();
  return text + "\n" + chart_examples;
}

}  // namespace

void add_chart(CLI::App& app, Action& action, const std::string& command_line) {
  const auto options = std::make_shared<ChartArguments>();
  CLI::App* sub = app.add_subcommand(
      "chart", "Time against error of every method, on a scene or a sample of yours");
  add_options(*sub, *options);
  sub->footer(footer());
  sub->callback([options, &action, command_line] {
    action = [options, command_line] {
      const bool folder = is_folder(*options);
      if (!folder) refuse_other_kind(*options, false);
      else if (workflow::is_sample(options->scene.given().at("specimen.input").front()))
        refuse_other_kind(*options, true);
      return folder ? chart_folder(*options, command_line) : chart(*options, command_line);
    };
  });
}

}  // namespace surf::cli
