// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate_job_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "common_options.h"
#include "options.h"
#include "scene_options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/mc/choose_method.h"
#include "terminal.h"

namespace surf::cli {
namespace {

workflow::Extras make_extras(const SimulateOptions& o) {
  workflow::Extras extras;
  for (std::size_t from = 0; from < o.channels.size();) {
    const std::size_t comma = std::min(o.channels.find(',', from), o.channels.size());
    extras.channels.push_back(o.channels.substr(from, comma - from));
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

// One of these says how much is simulated, and goes before what the scene file says of it.
void refuse_two_budgets(const SimulateOptions& o) {
  const char* first = nullptr;
  for (const auto& [given, name] :
       {std::pair{o.electrons.has_value(), "--electrons"},
        std::pair{o.accuracy.has_value(), "--accuracy"}, std::pair{o.time.has_value(), "--time"},
        std::pair{o.scene.current || o.scene.dwell, "--current and --dwell"}}) {
    if (!given) continue;
    if (first)
      throw UsageError(first, fmt::format("with {} there are two ways to say how much is simulated", name),
                       fmt::format("Leave out {}, or {}", first, name));
    first = name;
  }
}

void apply_budget(const SimulateOptions& o, std::int64_t electrons, workflow::SimulateJob& job) {
  io::SceneFile& scene = job.scene;
  const bool given = o.electrons || o.accuracy || o.time;
  if (given) {
    scene.electrons = std::nullopt;
    scene.accuracy = std::nullopt;
    scene.current_pa = scene.dwell_us = std::nullopt;
  }
  if (o.scene.current || o.scene.dwell) scene.accuracy = std::nullopt;
  if (o.electrons) scene.electrons = electrons;
  if (o.accuracy) scene.accuracy = parse_share(*o.accuracy, "--accuracy");
  if (o.time) {
    job.seconds = parse_duration_s(*o.time, "--time");
    if (!(job.seconds > 0))
      throw UsageError("--time", "it must be above zero", "Write for example 30s");
  }
  if (o.accuracy_floor) {
    if (!scene.accuracy && !o.time)
      throw UsageError("--accuracy-floor", "there is no accuracy that it could limit",
                       "Add --accuracy 1%, or leave it out");
    scene.accuracy_floor = *o.accuracy_floor == "0"
                               ? 0 : parse_share(*o.accuracy_floor, "--accuracy-floor");
  }
  if (!scene.accuracy && !o.time) scene.accuracy_floor = std::nullopt;
}

std::optional<double> parse_tolerance(const SimulateOptions& o) {
  if (!o.mesh_tolerance) return std::nullopt;
  const double nm = parse_length_nm(*o.mesh_tolerance, "--mesh-tolerance");
  if (nm >= 0) return nm;
  throw UsageError("--mesh-tolerance", fmt::format("'{}' is negative", *o.mesh_tolerance),
                   "Give 0 or a length such as 0.5nm");
}

}  // namespace

workflow::SimulateJob make_simulate_job(const SimulateOptions& o, const std::string& command_line,
                                       const io::BodyReader& read) {
  workflow::SimulateJob job;
  // Numbers first: a bad one should not wait for a large mesh to be read.
  const std::int64_t electrons =
      o.electrons ? parse_whole(*o.electrons, "--electrons", 1, std::int64_t{1} << 31) : 0;
  const std::uint64_t seed = o.seed ? parse_seed(*o.seed, "--seed") : 0;
  job.options.threads = parse_threads(o.threads);

  const std::optional<double> tolerance = parse_tolerance(o);
  refuse_two_budgets(o);
  std::optional<std::optional<mc::Method>> method;
  if (o.method) method = mc::parse_method(*o.method, "--method");

  std::vector<std::string> notes;
  if (o.outputs.empty() && !o.scene.inputs.empty())
    throw UsageError("--output", "no output file is given", "Add -o image.exr");
  job.scene = make_scene(o.scene, notes, read);
  apply_budget(o, electrons, job);
  job.options.budget = mc::ElectronsPerPixel{job.scene.electrons.value_or(job.options.electrons)};
  if (method) job.scene.method = *method;
  if (tolerance) job.scene.mesh_tolerance_nm = tolerance;
  job.cache = io::cache_folder(o.cache.value_or(""));
  job.options.spectra = o.spectra;
  job.extras = make_extras(o);
  job.checkpoint = make_checkpoint(o);
  job.options.seed = o.seed ? seed : job.scene.seed.value_or(job.options.seed);
  job.outputs.assign(o.outputs.begin(), o.outputs.end());
  job.png_channel = o.channel;
  job.layout = o.layout == "rows" ? io::Layout::rows : o.layout == "tiles" ? io::Layout::tiles : io::Layout::automatic;
  job.command_line = command_line;
  if (!o.quiet)
    for (const std::string& note : notes) print_note(note);
  return job;
}

}  // namespace surf::cli
