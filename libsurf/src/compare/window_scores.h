// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/compare/find_changes.h"

namespace surf {

/// Errors of a difference as they are used.
struct DifferenceErrors {
  Grid<double> random;      ///< standard deviation
  Grid<double> systematic;  ///< may be empty
  std::vector<Grid<double>> common;
  NoiseCorrelation correlation;
  Mask valid;  ///< of the grids' size

  Grid<double> total() const;
};

/// Sums over rectangles of a grid.
class BoxSums {
 public:
  BoxSums(int width, int height) : sums_(width + 1, height + 1) {}
  /// `value` is called with the row-major index of a sample.
  template <class ValueAt>
  void fill(const ValueAt& value) {
    std::size_t i = 0;
    for (int y = 1; y < sums_.height(); ++y) {
      double row = 0;
      for (int x = 1; x < sums_.width(); ++x) {
        row += value(i++);
        sums_(x, y) = sums_(x, y - 1) + row;
      }
    }
  }
  /// Over [x0, x1) x [y0, y1).
  double within(int x0, int y0, int x1, int y1) const {
    return sums_(x1, y1) - sums_(x0, y1) - sums_(x1, y0) + sums_(x0, y0);
  }
  /// Over [x, x + size) x [y, y + size).
  double square(int x, int y, int size) const { return within(x, y, x + size, y + size); }

 private:
  Grid<double> sums_;
};

/// A square window by its lower-left sample.
struct Window {
  int x = 0, y = 0, size = 1;
  double score = 0;  ///< mean over standard deviation, with its sign
  double mean = 0;
};

/// Means over windows of several sizes, over their standard deviations.
class WindowScores {
 public:
  WindowScores(const DifferenceErrors& errors, std::vector<int> sizes);

  /// The largest score of all windows, either sign. Differences that are not valid do not count.
  template <class ValueAt>
  double largest(const ValueAt& difference) const {
    double most = 0;
    each(difference,
         [&](std::size_t, int, int, double score) { most = std::max(most, std::abs(score)); });
    return most;
  }

  /// Windows whose score is above the threshold, strongest first.
  std::vector<Window> above(const Grid<double>& difference, double threshold) const;

  /// For each sample the largest score of the windows that it is in the middle of.
  Grid<double> centred(const Grid<double>& difference) const;

  /// Weighted sums of a difference, for the scores of single windows.
  using Sums = BoxSums;
  Sums sums_of(const Grid<double>& difference) const;
  double score(const Sums& sums, const Window& window) const;

  const std::vector<int>& sizes() const { return sizes_; }

 private:
  template <class ValueAt>
  BoxSums weighted(const ValueAt& difference) const {
    BoxSums sums(weight_.width(), weight_.height());
    sums.fill([&](std::size_t i) {
      return weight_.data()[i] > 0 ? difference(i) * weight_.data()[i] : 0.0;
    });
    return sums;
  }

  template <class ValueAt, class Use>
  void each(const ValueAt& difference, const Use& use) const {
    const BoxSums sums = weighted(difference);
    for (std::size_t k = 0; k < sizes_.size(); ++k)
      for (int y = 0; y < per_deviation_[k].height(); ++y)
        for (int x = 0; x < per_deviation_[k].width(); ++x)
          if (per_deviation_[k](x, y) > 0)
            use(k, x, y, sums.square(x, y, sizes_[k]) * double(per_deviation_[k](x, y)));
  }

  std::vector<int> sizes_;
  Grid<double> weight_;  // inverse variance; 0: not valid
  BoxSums weights_;
  std::vector<Grid<float>> per_deviation_;  // of each size; 0: too few samples
};

}  // namespace surf
