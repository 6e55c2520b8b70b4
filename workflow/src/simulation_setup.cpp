// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "extras.h"
#include "sidecar.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/overlaps.h"
#include "time_budget.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_electrons = std::int64_t{1} << 31;

std::vector<io::FileUse> inputs_of(const SimulateJob& job) {
  std::vector<io::FileUse> inputs;
  for (const fs::path& input : job.scene.inputs) inputs.push_back({"INPUT", input, {}});
  return inputs;
}

/// The images, and what is written beside them.
std::vector<io::FileUse> outputs_of(const SimulateJob& job) {
  std::vector<io::FileUse> outputs;
  std::set<fs::path> records;   // images of one name share theirs
  for (const fs::path& output : job.outputs) {
    outputs.push_back({"`output`", output, {}});
    if (const fs::path record = sidecar_path(output); records.insert(record).second)
      outputs.push_back({"`output`", record, output});
  }
  for (const fs::path& extra : extra_files(job)) outputs.push_back({"`output`", extra, job.outputs.front()});
  return outputs;
}

void refuse_strangers_of(const SimulateJob& job) {
  const std::vector<fs::path> extras = extra_files(job);
  for (const fs::path& output : job.outputs) io::refuse_strangers(output, {sidecar_path(output)});
  io::refuse_strangers(sidecar_path(job.outputs.front()), extras);
}

}  // namespace

void check_options(const mc::SimulationOptions& options) {
  if (options.electrons < 1 || options.electrons > max_electrons)
    throw UsageError("`simulation.electrons`", fmt::format("{} is out of range", options.electrons),
                     "Give 1 to 2147483648 electrons per pixel");
  if (options.threads < 0)
    throw UsageError("`simulation.threads`", fmt::format("{} is out of range", options.threads),
                     "Give 1 or more, or 0 for one per hardware thread");
  if (options.tile_pixels < 1)
    throw UsageError("tile_pixels", fmt::format("{} is out of range", options.tile_pixels),
                     "Give 1 or more");
}

SimulateJob complete(SimulateJob out) {
  const io::SceneFile& s = out.scene;
  for (const mc::Detector& d : s.detectors) out.options.detectors.push_back(d);
  mc::validate(out.options.detectors);
  mc::validate(s.beam);
  mc::validate(s.physics, s.beam.energy_ev);
  if (s.current_pa.has_value() != s.dwell_us.has_value())
    throw UsageError(s.current_pa ? "`beam.current`" : "`beam.dwell`", "the other of the two is missing",
                     "Current and dwell time together make the dose of a pixel: give both");
  if (s.current_pa) {
    if (!(*s.current_pa > 0 && *s.dwell_us > 0))
      throw UsageError("`beam.current`, `beam.dwell`", "they must be above zero",
                       "Write for example `beam.current=100pA` `beam.dwell=1us`");
    if (s.electrons)
      throw UsageError("`simulation.electrons`", "current and dwell time give the number of primaries",
                       "Leave out `simulation.electrons`, or `beam.current` and `beam.dwell`");
    out.options.dose = *s.current_pa * *s.dwell_us * electrons_per_pa_us;
  }
  if (s.accuracy) out.options.accuracy = *s.accuracy;
  if (s.accuracy_floor) out.options.accuracy_floor = *s.accuracy_floor;
  if (out.seconds < 0 || !std::isfinite(out.seconds))
    throw UsageError("`simulation.time`", "it must be above zero", "Write for example 30s");
  if (out.seconds > 0) out.options.accuracy = coarse_accuracy;
  if (out.options.accuracy > 0 && s.electrons)
    throw UsageError("`simulation.electrons`", "a wanted accuracy gives the number of primaries",
                     "Leave out one of the two");
  if (out.options.scratch_folder.empty() && !out.outputs.empty()) {
    const fs::path folder = out.outputs.front().parent_path();
    out.options.scratch_folder = folder.empty() ? "." : folder.string();
  }
  if (out.png_channel.empty()) out.png_channel = out.options.dose > 0 ? "SE.shot" : "SE";
  return out;
}

Image image_like_the_result(const SimulateJob& job) {
  mc::SimulationResult result;
  result.detectors = job.options.detectors;
  result.dose = job.options.dose;
  result.pixels = LargeGrid<mc::PixelTally>(1, 1);
  for (std::size_t d = 0; d < result.detectors.size(); ++d) result.counts.emplace_back(1, 1);
  mc::Scan scan;
  scan.width = scan.height = 1;
  Image image = mc::make_image(result, scan);
  for (const std::string& name : extra_channels(job))
    image.channels.push_back({name, "1", Grid<float>(1, 1)});
  return image;
}

void check_outputs(const SimulateJob& job) {
  if (job.outputs.empty())
    throw UsageError("`output`", "no output file is given", "Add `output=image.exr`");
  const Image image = image_like_the_result(job);
  io::refuse_overlaps(inputs_of(job), outputs_of(job));
  refuse_strangers_of(job);
  for (const fs::path& extra : extra_files(job)) io::check_writable(extra);
  for (const fs::path& output : job.outputs) {
    io::check_image_target(output, &image, {job.png_channel});
    io::check_writable(output);
    io::check_writable(sidecar_path(output));
  }
}

void check_checkpoint(const SimulateJob& job) {
  const CheckpointOptions& o = job.checkpoint;
  if (!(o.seconds > 0))
    throw UsageError("`output.checkpoint_every`", "it must be above zero", "Write for example 30s");
  if (!o.wanted || o.file.empty()) return;
  if (job.extras.deposit_cells > 0)
    throw UsageError("`output.checkpoint`", "deposited energy cannot be kept on the way",
                     "Leave out `output.checkpoint` or `output.deposit`");
  std::vector<io::FileUse> outputs = outputs_of(job);
  outputs.push_back({"`output.checkpoint`", o.file, {}});
  io::refuse_overlaps(inputs_of(job), outputs);
  io::check_writable(o.file);
}

mc::Scene make_scene(const SimulateJob& job, const SpecimenFacts& facts, mc::NodeMemory* node,
                     const NoteCallback& tell, const CancelToken* cancel, SimulateSummary& summary) {
  const io::SceneFile& s = job.scene;
  const double tolerance_nm = s.mesh_tolerance_nm.value_or(0);
  const Watch watch{{}, cancel};
  if (tolerance_nm == 0)
    return mc::Scene(s.specimen, s.beam, summary.scan, s.physics,
                     {.facts = &facts.bodies, .node = node, .watch = watch});
  if (tell) tell(fmt::format("leaving out detail below {}", format_length(tolerance_nm)));
  mc::Specimen simple;
  std::vector<mc::BodyFacts> of_simple;
  once_per_node(node, [&] {
    simple = simplify_specimen(s.specimen, tolerance_nm, s.beam, summary.scan, s.physics,
                               job.options.threads, summary.simplification, watch);
    of_simple = mc::validate(simple, watch);
    return std::string();
  });
  if (node && !node->is_first()) simple = s.specimen;
  return mc::Scene(simple, s.beam, summary.scan, s.physics, {.facts = &of_simple, .node = node, .watch = watch});
}

}  // namespace surf::workflow
