// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surf/core/grid.h"

namespace surf::reconstruction {

/// A rectangle of samples of a field; ends are excluded.
struct Area {
  int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
  int width() const { return x_end - x_begin; }
  int height() const { return y_end - y_begin; }
  int samples() const { return width() * height(); }
};

/// A symmetric matrix between samples of a field that are at most two steps along x and y apart.
/// The entry of each pair is stored at its later sample in row-major order.
class StencilMatrix {
 public:
  /// A place relative to a sample.
  struct Offset {
    int dx, dy;
  };
  static constexpr int slots = 7;
  /// Where the pairs of a sample lie: they rise in row-major order, the sample itself is the last.
  static constexpr Offset offsets[slots] = {{0, -2}, {-1, -1}, {0, -1}, {1, -1},
                                            {-2, 0}, {-1, 0},  {0, 0}};

  StencilMatrix(int width, int height)
      : width_(width), height_(height), values_(static_cast<std::size_t>(width) * height * slots) {}

  int width() const { return width_; }
  int height() const { return height_; }

  /// Adds to the entry of a pair of samples, given in either order.
  void add(int x0, int y0, int x1, int y1, double v) {
    if (y1 > y0 || (y1 == y0 && x1 > x0)) {
      std::swap(x0, x1);
      std::swap(y0, y1);
    }
    values_[index(x0, y0, slot(x1 - x0, y1 - y0))] += v;
  }

  /// The entry of sample (x, y) and the one at the slot's offset.
  double at(int x, int y, int s) const { return values_[index(x, y, s)]; }

  /// Calls entry(row, value) for column k of the matrix restricted to the area, whose samples are
  /// numbered row by row. Rows rise, with the diagonal last. All entries within the area are
  /// visited, so the pattern does not depend on the values.
  template <class Entry>
  void for_each_in_column(const Area& area, int k, const Entry& entry) const {
    const int x = k % area.width(), y = k / area.width();
    const double* values = &values_[index(x + area.x_begin, y + area.y_begin, 0)];
    for (int s = 0; s < slots; ++s) {
      const int u = x + offsets[s].dx, v = y + offsets[s].dy;
      if (u < 0 || u >= area.width() || v < 0) continue;
      entry(v * area.width() + u, values[s]);
    }
  }

  /// `y` less the product of the matrix, restricted to the area, with `x`; both of the area's size.
  void subtract_product(const Area& area, const Grid<double>& x, Grid<double>& y) const {
    for (int k = 0; k < area.samples(); ++k)
      for_each_in_column(area, k, [&](int row, double v) {
        y.data()[k] -= v * x.data()[row];
        if (row != k) y.data()[row] -= v * x.data()[k];
      });
  }

  /// The largest sum of absolute entries in a row of the matrix restricted to the area: at least
  /// the largest eigenvalue.
  double largest_row(const Area& area) const {
    std::vector<double> sums(area.samples());
    for (int k = 0; k < area.samples(); ++k)
      for_each_in_column(area, k, [&](int row, double v) {
        sums[k] += std::fabs(v);
        if (row != k) sums[row] += std::fabs(v);
      });
    return *std::max_element(sums.begin(), sums.end());
  }

 private:
  static constexpr int slot(int dx, int dy) {  // dy < 0, or dy = 0 and dx <= 0
    return dy == -2 ? 0 : dy == -1 ? 2 + dx : 6 + dx;
  }
  std::size_t index(int x, int y, int s) const {
    return (static_cast<std::size_t>(y) * width_ + x) * slots + s;
  }

  int width_, height_;
  std::vector<double> values_;
};

}  // namespace surf::reconstruction
