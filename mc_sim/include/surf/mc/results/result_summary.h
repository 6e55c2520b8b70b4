// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/mc/results/simulation_result.h"

namespace surf::mc {

inline constexpr int pixel_models = 5;
const char* name(PixelModel model);

/// What a result looks like as a whole.
struct ResultSummary {
  std::int64_t pixels = 0;                          ///< of the scan
  std::int64_t seen = 0;                            ///< that see the specimen
  std::array<std::int64_t, pixel_models> models{};  ///< pixels by `PixelModel`
  /// Primaries whose counts were kept, of the pixels of each `PixelModel`.
  std::array<std::int64_t, pixel_models> electrons{};
  /// The same, over the pixels that see the specimen; 0 where it is a plane.
  double mean_electrons = 0;
  std::int64_t fewest_electrons = 0, most_electrons = 0;
  /// Per detector the yield's mean over those pixels. Its standard error takes the share that comes
  /// from the library as common to all pixels, the rest as independent.
  std::vector<Estimate> yields;
  /// With an accuracy: pixels where some detector's standard error is more than `missed_by` times
  /// what was asked for, and the worst of all, as a multiple.
  std::int64_t missed = 0;
  double worst = 0;

  static constexpr double missed_by = 1.1;
};

ResultSummary summarize(const SimulationResult& result);

/// Planes that pixels of a result were compared with, as far as its tallies show.
std::size_t planes_used(const SimulationResult& result);

}  // namespace surf::mc
