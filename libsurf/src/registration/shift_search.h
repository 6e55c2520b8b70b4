// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// Samples and which of them there are (1 or 0); absent ones are 0 in `values`.
struct MaskedGrid {
  Grid<float> values, mask;
};

/// Where one image lies in another.
struct ShiftPeak {
  int x = 0, y = 0;            ///< sample (0, 0) of the moving image is this sample of the resting one
  double correlation = 0;
  double samples = 0;          ///< that overlap
  double evidence = 0;         ///< as of Agreement
};

/// Normalised cross-correlation of masked images at every shift at once, by Fourier transforms
/// (Padfield 2012, doi:10.1109/TIP.2011.2181402).
class ShiftSearch {
 public:
  /// `least_share` of the smaller image must overlap. Images to be moved are at most as large as one of `sizes`.
  ShiftSearch(MaskedGrid resting, double least_share, const std::vector<std::pair<int, int>>& sizes);
  ~ShiftSearch();

  /// The best `count` peaks, best first; fewer where there are fewer. From any thread.
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
