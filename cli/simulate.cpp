// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "commands.h"
#include "options.h"
#include "scene_options.h"
#include "simulate_options.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "surf/workflow/simulate_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

struct Yield {
  double mean = 0, standard_error = 0;
};

// Mean over the pixels that see the specimen; their errors are independent.
Yield mean_yield(const mc::SimulationResult& result, std::size_t detector, std::size_t& pixels) {
  double sum = 0, variance = 0;
  pixels = 0;
  for (int y = 0; y < result.pixels.height(); ++y) {
    for (int x = 0; x < result.pixels.width(); ++x) {
      if (result.pixels(x, y).hits == 0) continue;
      const mc::Estimate e = result.yield(detector, x, y);
      sum += e.mean;
      variance += e.standard_error * e.standard_error;
      ++pixels;
    }
    result.release();
  }
  if (pixels == 0) return {};
  return {sum / double(pixels), std::sqrt(variance) / double(pixels)};
}

void print_summary(const workflow::SimulateJob& job, const workflow::SimulateSummary& s) {
  const mc::Scan& scan = s.scan;
  const std::string pixel = scan.pixel_x_nm == scan.pixel_y_nm
                                ? format_length(scan.pixel_x_nm)
                                : format_length(scan.pixel_x_nm) + " x " +
                                      format_length(scan.pixel_y_nm);
  fmt::print("{:<10} {} x {} pixels of {}, {} x {}{}\n", "image", scan.width, scan.height, pixel,
             format_length(scan.width * scan.pixel_x_nm),
             format_length(scan.height * scan.pixel_y_nm), s.result.complete ? "" : " (partial)");
  std::size_t pixels = 0;
  std::size_t width = 10;
  for (const mc::Detector& d : s.result.detectors) width = std::max(width, d.name.size());
  for (std::size_t d = 0; d < s.result.detectors.size(); ++d) {
    const Yield y = mean_yield(s.result, d, pixels);
    fmt::print("{:<{}} {:.4f} ± {:.4f}{}\n", s.result.detectors[d].name, width, y.mean, y.standard_error,
               d == 0 ? fmt::format(" per primary, mean over {} pixels", pixels) : "");
  }
  if (s.result.dose > 0)
    fmt::print("{:<10} {:.4g} primaries per pixel on average\n", "dose", s.result.dose);
  const double recalled = double(s.result.recalled);
  const double primaries = double(s.result.balance.incident) - recalled;
  const double seconds = s.result.seconds;
  fmt::print("{:<10} {}{} in {:.1f} s, {} per second on {} threads\n", "primaries",
             recalled > 0 ? format_count(recalled) + " done before, " : "", format_count(primaries),
             seconds, format_count(seconds > 0 ? primaries / seconds : 0),
             resolve_threads(job.options.threads));
  const char* label = "written";
  for (const auto& path : s.written) {
    fmt::print("{:<10} {}\n", label, path.string());
    label = "";
  }
}

workflow::Extras make_extras(const SimulateOptions& o) {
  workflow::Extras extras;
  for (std::size_t from = 0; from < o.channels.size();) {
    const std::size_t comma = std::min(o.channels.find(',', from), o.channels.size());
    extras.surface.push_back(o.channels.substr(from, comma - from));
    from = comma + 1;
  }
  if (o.deposit)
    extras.deposit_cells = static_cast<int>(parse_whole(*o.deposit, "--deposit", 1, 1024));
  if (o.trajectories)
    extras.trajectories =
        static_cast<int>(parse_whole(*o.trajectories, "--trajectories", 1, 100'000));
  if (o.trajectories_at) {
    const auto comma = o.trajectories_at->find(',');
    if (comma == std::string::npos)
      throw UsageError("--trajectories-at", "it is not a point", "Write two lengths, X,Y");
    extras.trajectories_at_nm = {
        parse_length_nm(o.trajectories_at->substr(0, comma), "--trajectories-at"),
        parse_length_nm(o.trajectories_at->substr(comma + 1), "--trajectories-at")};
  }
  return extras;
}

workflow::CheckpointOptions make_checkpoint(const SimulateOptions& o) {
  workflow::CheckpointOptions checkpoint;
  checkpoint.restart = o.restart;
  if (o.checkpoint && *o.checkpoint == "off") checkpoint.wanted = false;
  else if (o.checkpoint) checkpoint.file = *o.checkpoint;
  if (o.checkpoint_every)
    checkpoint.seconds = parse_duration_s(*o.checkpoint_every, "--checkpoint-every");
  return checkpoint;
}

workflow::SimulateJob make_job(const SimulateOptions& o, const std::string& command_line) {
  workflow::SimulateJob job;
  // Numbers first: a bad one should not wait for a large mesh to be read.
  const std::int64_t electrons =
      o.electrons ? parse_whole(*o.electrons, "--electrons", 1, std::int64_t{1} << 31) : 0;
  const std::uint64_t seed = o.seed ? parse_seed(*o.seed, "--seed") : 0;
  if (o.threads)
    job.options.threads = static_cast<int>(parse_whole(*o.threads, "--threads", 0, 4096));

  std::vector<std::string> notes;
  if (o.outputs.empty() && !o.scene.inputs.empty())
    throw UsageError("--output", "no output file is given", "Add -o image.exr");
  job.scene = make_scene(o.scene, notes);
  if (o.electrons) {
    if (o.scene.current || o.scene.dwell)
      throw UsageError("--electrons", "current and dwell time give the number of primaries",
                       "Leave out --electrons, or --current and --dwell");
    job.scene.electrons = electrons;
    job.scene.current_pa = job.scene.dwell_us = std::nullopt;
  }
  job.options.electrons = job.scene.electrons.value_or(job.options.electrons);
  job.options.spectra = o.spectra;
  job.extras = make_extras(o);
  job.checkpoint = make_checkpoint(o);
  job.options.seed = o.seed ? seed : job.scene.seed.value_or(job.options.seed);
  job.outputs.assign(o.outputs.begin(), o.outputs.end());
  job.png_channel = o.channel;
  job.command_line = command_line;
  if (!o.quiet)
    for (const std::string& note : notes) print_note(note);
  return job;
}

int simulate(const SimulateOptions& options, const std::string& command_line) {
  const workflow::SimulateJob job = make_job(options, command_line);
  workflow::SimulateSummary summary;
  {
    InterruptGuard interrupts;
    ProgressBar bar(!options.quiet);
    summary = workflow::run(
        job, [&](double done, double total) { bar.show(done, total); }, interrupts.token(),
        [&](const std::string& warning) {
          bar.clear();
          print_warning(warning);
        },
        [&](const std::string& note) {
          bar.clear();
          if (!options.quiet) print_note(note);
        });
  }
  if (!options.quiet) print_summary(job, summary);
  return summary.result.complete ? 0 : 130;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action, const std::string& command_line) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* sub = app.add_subcommand(
      "simulate", "Secondary- and backscattered-electron images of a specimen");
  sub->group("Commands");
  add_simulate_options(*sub, *options);
  sub->callback([options, &action, command_line] {
    action = [options, command_line] { return simulate(*options, command_line); };
  });
}

}  // namespace surf::cli
