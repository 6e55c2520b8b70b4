// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "extras.h"
#include "share_surfaces.h"
#include "sidecar.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/overlaps.h"
#include "surf/workflow/simplify_specimen.h"
#include "time_budget.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

std::vector<io::FileUse> inputs_of(const ResolvedJob& job) {
  std::vector<io::FileUse> inputs;
  for (const fs::path& input : job.scene.inputs) inputs.push_back({"INPUT", input, {}});
  return inputs;
}

/// The images, and the files written beside them.
std::vector<io::FileUse> outputs_of(const ResolvedJob& job) {
  std::vector<io::FileUse> outputs;
  std::set<fs::path> records;  // images of one name share their record
  for (const fs::path& output : job.outputs) {
    outputs.push_back({"`output`", output, {}});
    if (const fs::path record = sidecar_path(output); records.insert(record).second)
      outputs.push_back({"`output`", record, output});
  }
  for (const fs::path& extra : extra_files(job))
    outputs.push_back({"`output`", extra, job.outputs.front()});
  return outputs;
}

void refuse_strangers_of(const ResolvedJob& job) {
  const std::vector<fs::path> extras = extra_files(job);
  for (const fs::path& output : job.outputs) io::refuse_strangers(output, {sidecar_path(output)});
  io::refuse_strangers(sidecar_path(job.outputs.front()), extras);
}

}  // namespace

ResolvedJob resolve(SimulateJob asked) {
  ResolvedJob out{std::move(asked), {}};
  mc::validate(out.scene);
  if (out.execution.tile_pixels < 1)
    throw UsageError("tile_pixels", fmt::format("{} is out of range", out.execution.tile_pixels),
                     "Give 1 or more");
  if (out.execution.scratch_folder.empty() && !out.outputs.empty()) {
    const fs::path folder = out.outputs.front().parent_path();
    out.execution.scratch_folder = folder.empty() ? "." : folder.string();
  }
  out.options = mc::options_of(out.scene, out.execution);
  out.options.spectra = out.spectra;
  out.options.odd_counts = wants_counts(out.extras);
  if (const auto* const limit = std::get_if<mc::TimeLimit>(&out.scene.budget))
    out.options.budget = mc::Accuracy{coarse_accuracy, limit->floor};
  if (out.png_channel.empty())
    out.png_channel = mc::dose_of(out.options.budget) > 0 ? "SE.shot" : "SE";
  return out;
}

Image image_like_the_result(const ResolvedJob& job) {
  mc::SimulationResult result;
  result.detectors = job.options.detectors;
  result.budget = job.options.budget;
  result.pixels = LargeGrid<mc::PixelTally>(1, 1);
  for (std::size_t d = 0; d < result.detectors.size(); ++d) result.counts.emplace_back(1, 1);
  mc::Scan scan;
  scan.width = scan.height = 1;
  Image image = mc::make_image(result, scan);
  for (const std::string& name : extra_channels(job))
    image.channels.push_back({name, "1", Grid<float>(1, 1)});
  return image;
}

void check_outputs(const ResolvedJob& job) {
  if (job.outputs.empty()) {
    if (job.keep_image) return;  // the caller takes it from memory
    throw UsageError("`output`", "no output file is given", "Add `output=image.exr`");
  }
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

void check_checkpoint(const ResolvedJob& job) {
  const CheckpointOptions& o = job.checkpoint;
  if (!(o.seconds > 0))
    throw UsageError("`job.checkpoint_every`", "it must be above zero", "Write for example 30s");
  if (!o.wanted || o.file.empty()) return;
  if (job.extras.deposit_cells > 0)
    throw UsageError("`job.checkpoint`", "deposited energy cannot be kept on the way",
                     "Leave out `job.checkpoint` or `output.deposit`");
  std::vector<io::FileUse> outputs = outputs_of(job);
  outputs.push_back({"`job.checkpoint`", o.file, {}});
  io::refuse_overlaps(inputs_of(job), outputs);
  io::check_writable(o.file);
}

mc::Scene make_scene(const ResolvedJob& job, const SpecimenFacts& facts, NodeMemory* node,
                     const NoteCallback& tell, const CancelToken* cancel,
                     SimulateSummary& summary) {
  const io::SceneFile& s = job.scene;
  const double tolerance_nm = s.mesh_tolerance_nm;
  const Watch watch{{}, cancel};
  if (tolerance_nm > 0 && tell)
    tell(fmt::format("leaving out detail below {}", format_length(tolerance_nm)));
  const auto surfaces = [&] {
    if (tolerance_nm == 0)
      return mc::make_surfaces(s.specimen, facts.bodies, s.beam, summary.scan, s.physics,
                               {.watch = watch});
    const mc::Specimen simple =
        simplify_specimen(s.specimen, tolerance_nm, s.beam, summary.scan, s.physics,
                          job.options.threads, summary.simplification, watch);
    return mc::make_surfaces(simple, mc::validate(simple, watch), s.beam, summary.scan, s.physics,
                             {.watch = watch});
  };
  return mc::Scene(node ? share_surfaces(*node, surfaces) : surfaces(), s.specimen.materials,
                   s.beam, summary.scan, s.physics, {.watch = watch});
}

}  // namespace surf::workflow
