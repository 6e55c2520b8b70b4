// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/sem/guided_estimate.h"

namespace surf::guided {

/// What one half of the primaries gave at each pixel.
struct HalfCounts {
  std::vector<double> mean, primaries;
  std::vector<double> scatter;  ///< sample variance of one primary's count; < 0: not known
};

/// The pixels of one region: what their counts say without any model.
struct RegionCounts {
  int width = 0, height = 0;
  std::vector<std::uint8_t> seen;  ///< of the region, with primaries in both halves
  std::array<HalfCounts, 2> halves;

  bool counts(std::size_t i) const { return seen[i] != 0; }
  double primaries(std::size_t i) const { return halves[0].primaries[i] + halves[1].primaries[i]; }
  double mean(std::size_t i) const {
    return (halves[0].mean[i] * halves[0].primaries[i] +
            halves[1].mean[i] * halves[1].primaries[i]) /
           primaries(i);
  }
};

RegionCounts region_counts(const CountImage& counts, const Grid<int>& region, int number);

/// The variance of one primary's count as a function of the mean.
struct CountVariance {
  double slope = 1, square = 0;  ///< slope * m + square * m^2
  double least = 0;              ///< mean below which the variance stays as it is there
  double noise_scale = 1;  ///< of means over what scatter says: pixels share a library's cascades
  double noise_scale_doubt = 0;  ///< variance of `noise_scale`

  /// Of a mean of `primaries` counts.
  double of_mean(double mean, double primaries) const {
    return noise_scale * of_one(mean) / primaries;
  }
  double of_one(double mean) const;
};

constexpr double pilot_sigma_px = 1.5;

/// Means over a few pixels, to weigh counts by and to fit variances against.
std::vector<double> pilot_means(const RegionCounts& counts);

/// `library_cascades`: see GuidedOptions.
CountVariance fit_count_variance(const RegionCounts& counts, const std::vector<double>& pilot,
                                 double library_cascades);

}  // namespace surf::guided
