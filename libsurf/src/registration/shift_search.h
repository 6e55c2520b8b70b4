// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// Samples and a mask of the existing ones (1 or 0); missing samples are 0 in `values`.
struct MaskedGrid {
  Grid<float> values, mask;
};

/// Samples values by column and row, minus their mean and divided by their standard deviation.
template <class ValueAt, class HoldsAt>
MaskedGrid sampled(int width, int height, const ValueAt& value_at, const HoldsAt& holds_at) {
  MaskedGrid grid{Grid<float>(width, height), Grid<float>(width, height)};
  double sum = 0, squares = 0, count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!holds_at(x, y)) continue;
      const double v = value_at(x, y);
      grid.mask(x, y) = 1;
      grid.values(x, y) = static_cast<float>(v);
      sum += v;
      squares += v * v;
      count += 1;
    }
  if (count == 0) return grid;
  const double mean = sum / count,
               deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const double scale = deviation > 1e-9 * std::abs(mean) ? 1 / deviation : 0;
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    grid.values.data()[i] = grid.mask.data()[i] != 0
                                ? static_cast<float>((grid.values.data()[i] - mean) * scale)
                                : 0.0F;
  return grid;
}

/// A shift of one image over another where they agree.
struct ShiftPeak {
  int x = 0, y = 0;  ///< the moving image's sample (0, 0) lies at this sample of the resting image
  double correlation = 0;
  double samples = 0;   ///< number of samples that overlap
  double evidence = 0;  ///< as in Agreement
};

/// Normalised cross-correlation of masked images for all shifts at once, by Fourier transforms
/// (Padfield 2012, doi:10.1109/TIP.2011.2181402).
class ShiftSearch {
 public:
  /// At least `least_share` of the smaller image must overlap. Each moving image must be no larger
  /// than one of `sizes`.
  ShiftSearch(MaskedGrid resting, double least_share,
              const std::vector<std::pair<int, int>>& sizes);
  ~ShiftSearch();

  /// The best `count` peaks, best first, or all if there are fewer. Thread-safe.
  std::vector<ShiftPeak> peaks(const MaskedGrid& moving, std::size_t count) const;

 private:
  struct Plan;
  using Size = std::pair<int, int>;
  Size size_for(int width, int height) const;

  MaskedGrid resting_;
  double least_share_, resting_samples_ = 0;
  std::map<Size, std::unique_ptr<Plan>> plans_;
};

}  // namespace surf
