// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace surf::reconstruction {

/// A rectangle of samples of a field; ends are excluded.
struct Area {
  int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
  int width() const { return x_end - x_begin; }
  int height() const { return y_end - y_begin; }
  int samples() const { return width() * height(); }
};

/// A symmetric matrix between samples of a field that are at most two apart along x and y. The
/// entry of each pair is stored at its later sample in row-major order.
class StencilMatrix {
 public:
  static constexpr int slots = 13;  // two rows of five before the sample, and three in its own row

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
    values_[(static_cast<std::size_t>(y0) * width_ + x0) * slots + (y1 - y0 + 2) * 5 + (x1 - x0) +
            2] += v;
  }

  /// Calls entry(row, value) for column k of the matrix restricted to the area, whose samples are
  /// numbered row by row. Rows rise, with the diagonal last. All entries within the area are
  /// visited, so the pattern does not depend on the values.
  template <class Entry>
  void for_each_in_column(const Area& area, int k, const Entry& entry) const {
    const int x = k % area.width() + area.x_begin, y = k / area.width() + area.y_begin;
    const double* values = &values_[(static_cast<std::size_t>(y) * width_ + x) * slots];
    for (int s = 0; s < slots; ++s) {
      const int u = x + s % 5 - 2, v = y + s / 5 - 2;
      if (u < area.x_begin || u >= area.x_end || v < area.y_begin) continue;
      entry((v - area.y_begin) * area.width() + u - area.x_begin, values[s]);
    }
  }

 private:
  int width_, height_;
  std::vector<double> values_;
};

}  // namespace surf::reconstruction
