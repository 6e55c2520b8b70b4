// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/dry_run.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <utility>

#include "disk_needs.h"
#include "extras.h"
#include "guided/guide_model.h"
#include "guided/guided_simulation.h"
#include "job_libraries.h"
#include "simulation_setup.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/workflow/memory_estimate.h"
#include "time_budget.h"
#include "warnings.h"

namespace surf::workflow {
namespace {

// The bytes in a line such as "VmRSS:  1234 kB"; 0 if there is no such line.
double kilobytes_of(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, key.size(), key) == 0) return 1024 * std::stod(line.substr(key.size()));
  return 0;
}

// Of the counts, guides, fits and images of two detectors.
constexpr double guided_bytes_per_pixel = 700;

// The memory besides scene and libraries.
std::vector<MemoryNeed> memory_of_results(const ResolvedJob& job, const mc::Scan& scan) {
  std::vector<MemoryNeed> needs;
  const double pixels = static_cast<double>(scan.width) * scan.height;
  const auto limit = static_cast<double>(job.options.tally_memory);
  const auto tallies = static_cast<double>(mc::tally_bytes(scan, job.options));
  constexpr double part_of_a_scratch_file = 32e6;
  needs.push_back({"tallies", tallies > limit ? part_of_a_scratch_file : tallies});
  const auto channels = static_cast<double>(image_like_the_result(job).channels.size());
  double writing = 256 * 4 * channels * scan.width;
  for (const auto& output : job.outputs) {
    std::string extension = output.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".vti" || extension == ".hspy")
      writing = std::max(writing, 8 * channels * pixels);
  }
  // Larger ones are in scratch files (io/src/raster/pyramid.cpp).
  constexpr double most_of_a_level = 256e6 * 1.05;
  if (io::in_tiles(job.layout, {scan.width, scan.height}))
    for (double level = channels * pixels; level > 1e5; level /= 4)
      if (level <= most_of_a_level) writing += level;
  if (!job.extras.channels.empty())
    writing += std::min(limit, 4 * static_cast<double>(extra_channels(job).size()) * pixels);
  needs.push_back({"writing", writing});
  if (job.estimate.kind == Estimate::guided)
    needs.push_back({"guided images", guided_bytes_per_pixel * pixels});
  return needs;
}

}  // namespace

DryRun dry_run(SimulateJob asked, int ranks, double seconds, const Reporter& reporter) {
  const CancelToken* const cancel = reporter.cancel;
  check_extras(asked.extras);
  ResolvedJob job = resolve(std::move(asked));
  check_extras_of(job);
  check_outputs(job);
  check_checkpoint(job);
  SimulateSummary summary;
  DryRun out;
  const SpecimenFacts facts = facts_of(job.scene.specimen, nullptr, {{}, cancel});
  out.scan = summary.scan = resolve_scan(job.scene.scan, facts.extent, job.scene.beam);
  check_trajectories(job, out.scan);
  settle_estimate(job.estimate, job.options, out.scan);
  const mc::Scene scene = make_scene(job, facts, nullptr, reporter.on_note, cancel, summary);
  out.scene = scene.summary();
  out.warnings = warn_before(job, facts, out.scan);
  if (double fit = 1e6; job.estimate.kind == Estimate::guided) {
    job.options = expected_options(scene, job.options, fit);
    const double primaries = mc::mean_electrons_of(job.options.budget) * out.scan.width *
                             static_cast<double>(out.scan.height);
    if (job.seconds() == 0 && trains_guide_model(job.estimate, scene, job.cache, primaries))
      out.warnings.push_back(
          "a fast model is trained before, which takes minutes more; "
          "`simulation.guide_model=off` does without");
    job.options.odd_counts = true;
  }
  out.choice =
      mc::choose_method(scene, job.options, job.scene.method, {job.extras.deposit_cells > 0});
  job.options.method = out.choice.method;
  JobLibraries libraries(job.cache, reporter.counting("cascades"), reporter.on_note);
  out.pilot = mc::run_pilot(scene, job.options, seconds, &libraries,
                            {reporter.counting("primaries"), cancel});
  out.threads = resolve_threads(job.options.threads);
  out.ranks = ranks;
  out.expected_s = job.seconds() > 0 ? job.seconds() : out.pilot.expected_s / ranks;
  out.standard_error_s = job.seconds() > 0 ? 0 : out.pilot.standard_error_s / ranks;

  const double now = kilobytes_of("/proc/self/status", "VmRSS:");
  const auto library_bytes = static_cast<double>(out.pilot.library_bytes);
  const auto scene_bytes = static_cast<double>(out.scene.memory_bytes);
  out.memory = {{"ray tracing", scene_bytes}, {"libraries", library_bytes}};
  out.memory.push_back({"specimen and program", std::max(0.0, now - scene_bytes - library_bytes)});
  for (const MemoryNeed& need : memory_of_results(job, out.scan)) out.memory.push_back(need);
  for (const MemoryNeed& need : out.memory) out.memory_bytes += need.bytes;
  // Peak of reading the input.
  out.memory_bytes = std::max(out.memory_bytes, kilobytes_of("/proc/self/status", "VmHWM:"));
  const MemoryThere there = memory_there();
  out.memory_there = there.limit.empty() ? HUGE_VAL : now + static_cast<double>(there.bytes);
  out.disk = disk_needs(job, out.scan, out.pilot.packed_bytes);
  for (std::string& warning : warn_of_full_disks(out.disk))
    out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace surf::workflow
