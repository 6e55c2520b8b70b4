// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace surf::guided {

/// A Gaussian window on pixels, the product of a window along x and one along y. Its weights add up
/// to 1 and end at 3.5 standard deviations.
class GaussianWindow {
 public:
  explicit GaussianWindow(double sigma_px);

  int radius() const { return static_cast<int>(taps_.size()) - 1; }
  /// The weight of the pixel in the middle.
  double middle() const { return taps_[0] * taps_[0]; }

  /// The weighted sum around each pixel of a plane of `width` x `height` values, row by row.
  /// Outside the plane all values are 0. `plane` is overwritten by the result.
  void sum(std::vector<double>& plane, int width, int height, std::vector<double>& scratch) const;

 private:
  std::vector<double> taps_;  // from the middle outward, along one axis
};

}  // namespace surf::guided
