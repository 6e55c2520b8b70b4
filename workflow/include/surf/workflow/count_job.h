// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/io/sim/scene_file.h"
#include "surf/sem/count_distribution.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// How many electrons are counted where a beam stands still (thesis, 8.2.2): the same few primaries
/// at one point, many times over.
struct CountJob {
  io::SceneFile scene;  ///< its scan says where the middle is; no accuracy, no dose
  /// In the scan plane, as images have it, nm; absent: the middle of the scan.
  std::optional<std::pair<double, double>> at_nm;
  std::vector<std::int64_t> electrons = {
      1, 20, 100};               ///< primaries of a trial, each 1 to 1e6: one set each
  std::int64_t trials = 10'000;  ///< of each set, 100 to 1e7
  std::uint64_t seed = 1;        ///< no two trials or sets share random numbers
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
};

/// counts.at, counts.electrons, counts.trials, counts.seed and job.threads.
void describe(ParameterVisitor& visit, CountJob& job);

/// What one detector counted in the trials of one set.
struct DetectorCounts {
  std::string detector;
  std::int64_t electrons = 0;
  CountHistogram counts;  ///< ends with the largest count seen
};

struct CountSummary {
  std::vector<DetectorCounts>
      sets;     ///< by number of electrons, then detectors: SE, BSE, the scene's
  Vec3 hit_nm;  ///< where the beam's axis meets the specimen
};

/// Always simulates directly: replayed primaries share cascades, so that trials would not be
/// independent. Detectors' efficiencies do not count. Progress is in primaries. Throws UsageError
/// for numbers out of range, InvalidInput where the beam misses the specimen, Interrupted.
CountSummary run(const CountJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
