// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/simulate_job.h"

#include <fmt/format.h>

#include <algorithm>

#include "provenance.h"
#include "sidecar.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/mc/scene.h"
#include "warnings.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_electrons = std::int64_t{1} << 31;

void check_options(const mc::SimulationOptions& options) {
  if (options.electrons < 1 || options.electrons > max_electrons)
    throw UsageError("--electrons", fmt::format("{} is out of range", options.electrons),
                     "Give 1 to 2147483648 electrons per pixel");
  if (options.threads < 0)
    throw UsageError("--threads", fmt::format("{} is out of range", options.threads),
                     "Give 1 or more, or 0 for one per hardware thread");
  if (options.tile_pixels < 1)
    throw UsageError("tile_pixels", fmt::format("{} is out of range", options.tile_pixels),
                     "Give 1 or more");
}

// An image as the simulator makes them, small, to ask whether channels are known.
Image image_like_the_result() {
  mc::SimulationResult result;
  result.pixels = Grid<mc::PixelTally>(1, 1);
  mc::Scan scan;
  scan.width = scan.height = 1;
  return mc::make_image(result, scan);
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

void check_outputs(const SimulateJob& job) {
  if (job.outputs.empty())
    throw UsageError("--output", "no output file is given", "Add -o image.exr");
  const Image image = image_like_the_result();
  for (std::size_t i = 0; i < job.outputs.size(); ++i) {
    const fs::path& output = job.outputs[i];
    io::check_image_target(output, &image, {job.png_channel});
    io::check_writable(output);
    io::check_writable(sidecar_path(output));
    for (std::size_t j = 0; j < i; ++j)
      if (same_file(output, job.outputs[j]))
        throw UsageError("--output", output.string() + " is given twice", "Leave one out");
    for (const fs::path& input : job.scene.inputs)
      if (same_file(output, input))
        throw UsageError("--output", output.string() + " is an input", "Choose another name");
  }
}

Image labelled_image(const SimulateSummary& summary,
                     const std::map<std::string, std::string>& settings) {
  Image image = mc::make_image(summary.result, summary.scan);
  for (const auto& [key, value] : settings) image.metadata[key] = value;
  for (const auto& [key, value] : outcome(summary.result, summary.warnings))
    image.metadata[key] = value;
  return image;
}

void write_all(const SimulateJob& job, const Image& image, SimulateSummary& summary,
               RunRecord record) {
  for (const fs::path& output : job.outputs) {
    io::write_image(output, image, {job.png_channel});
    summary.written.push_back(output);
  }
  record.end = std::chrono::system_clock::now();
  record.outputs = job.outputs;
  const std::string text = sidecar_text(job, summary, record);
  for (const fs::path& output : job.outputs) {
    const fs::path path = sidecar_path(output);
    if (std::find(summary.written.begin(), summary.written.end(), path) != summary.written.end())
      continue;
    io::write_text(path, text);
    summary.written.push_back(path);
  }
}

}  // namespace

SimulateSummary run(const SimulateJob& job, const ProgressCallback& progress,
                    const CancelToken* cancel) {
  RunRecord record;
  record.start = std::chrono::system_clock::now();
  const io::SceneFile& s = job.scene;

  check_options(job.options);
  check_outputs(job);
  SimulateSummary summary;
  summary.scan = resolve_scan(s.scan, mc::extent(s.specimen), s.beam);
  record.inputs = hash_inputs(s.inputs);
  const mc::Scene scene(s.specimen, s.beam, summary.scan, s.physics);   // validates the specimen
  summary.scene = scene.summary();
  summary.warnings = warn_before(job, summary.scan);
  const auto settings = provenance(job, summary.scan, record.inputs);

  summary.result = mc::simulate(scene, job.options, progress, cancel);
  for (std::string& warning : warn_after(summary.result))
    summary.warnings.push_back(std::move(warning));

  write_all(job, labelled_image(summary, settings), summary, std::move(record));
  return summary;
}

}  // namespace surf::workflow
