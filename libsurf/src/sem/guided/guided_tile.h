// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "count_variance.h"
#include "local_regression.h"

namespace surf::guided {

inline constexpr int detail_classes = 3;
/// How much a pixel belongs to a class; 1 in all.
inline double share_of_class(int detail_class, double detail) {
  const double away = detail - detail_class;
  return away <= -1 || away >= 1 ? 0 : away < 0 ? 1 + away : 1 - away;
}

/// One region of an image, ready to be estimated.
struct GuidedRegion {
  RegionCounts counts;
  CountVariance variance;
  /// Variance of each half's mean at a pixel, by the pilot's means.
  std::array<std::vector<double>, 2> noise;
  /// The same by each pixel's own scatter: right on average.
  std::array<std::vector<double>, 2> raw_noise;
  std::vector<double> weight;  ///< of a squared error: 1 / yield^2; 0 outside the region
  /// Of mean 0 and variance 1, for each half.
  std::array<std::vector<std::vector<double>>, 2> guides;
  std::vector<int> predicting;  ///< numbers of the guides that predict the yield
  /// How sharply guides bend at each pixel, 0 to `detail_classes` - 1: pixels of unlike detail
  /// choose their estimates apart.
  std::vector<double> detail;
};

/// What is estimated of each pixel by one half, row by row over the image.
struct HalfPlanes {
  std::vector<double> value, variance, leverage;
};
struct GuidedPlanes {
  std::array<HalfPlanes, 2> halves;
  std::vector<double> spread;  ///< mean squared distance of the combined estimates from their mean
};

/// Pixels whose estimates are made at once; all that they need is in memory together.
inline constexpr int tile_px = 256;

/// Estimates the pixels of a tile. Each half's estimates are combined by weights that the other
/// half has chosen: so Stein's risk of them owes nothing to the choice.
void estimate_tile(const GuidedRegion& region, const PixelRange& tile, int threads,
                   GuidedPlanes& out);

}  // namespace surf::guided
