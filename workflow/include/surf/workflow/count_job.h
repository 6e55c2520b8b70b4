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

/// Counts the electrons of a beam that stands still (thesis, 8.2.2): trials of the same few
/// primaries at one point, many times over.
struct CountJob {
  io::SceneFile scene;  ///< its scan gives the middle; no accuracy, no dose
  /// The place of the beam in the scan plane, in image coordinates, nm; absent: the middle of the
  /// scan.
  std::optional<std::pair<double, double>> at_nm;
  /// Primaries per trial, each 1 to 1e6; each number makes one set of trials.
  std::vector<std::int64_t> electrons = {1, 20, 100};
  std::int64_t trials = 10'000;  ///< trials per set, 100 to 1e7
  std::uint64_t seed = 1;        ///< no two trials or sets share random numbers
  int threads = 0;               ///< 0: one per hardware thread. Does not change the result
};

/// The parameters counts.at, counts.electrons, counts.trials, counts.seed and job.threads.
void describe(ParameterVisitor& visit, CountJob& job);

/// The counts of one detector in the trials of one set.
struct DetectorCounts {
  std::string detector;
  std::int64_t electrons = 0;
  CountHistogram counts;  ///< up to the largest count seen
};

struct CountSummary {
  /// By number of electrons, then by detector: SE, BSE, the scene's.
  std::vector<DetectorCounts> sets;
  Vec3 hit_nm;  ///< point where the beam's axis meets the specimen
};

/// Runs the trials. Always simulates directly: replayed primaries share cascades, so that trials
/// would not be independent. Efficiencies of detectors are ignored. Progress is in primaries.
/// Throws UsageError for numbers out of range, InvalidInput if the beam misses the specimen,
/// Interrupted.
CountSummary run(const CountJob& job, const Reporter& reporter = {});

}  // namespace surf::workflow
