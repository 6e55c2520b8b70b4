// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// A scan made ready for tips: heights as floats, between a bottom that places tips and a top that
/// carves them, with a margin in which everything is allowed.
class CarvedScan {
 public:
  /// Heights that are not finite are holes. `layer` is added to the top and taken from the bottom.
  CarvedScan(const Grid<float>& heights, double layer, int tip_width, int tip_height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// +infinity where there is a hole, and beyond the border by as much as the tip is wide.
  const float* top(int x, int y) const { return &top_[offset(x, y)]; }
  /// -infinity where there is a hole.
  float bottom(int x, int y) const { return bottom_[offset(x, y)]; }
  std::ptrdiff_t stride() const { return stride_; }

 private:
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>((y + margin_y_) * stride_ + x + margin_x_);
  }

  int width_, height_, margin_x_, margin_y_;
  std::ptrdiff_t stride_;
  std::vector<float> top_, bottom_;
};

/// A tip's samples in rows of `stride` floats, -infinity beyond its width.
struct CarvedTip {
  int width = 0, height = 0, apex_x = 0, apex_y = 0;
  int stride = 0;                   ///< a multiple of 16
  std::vector<float> z, threshold;  ///< of a sample: lowered only by more than that
  std::vector<float> mirrored;  ///< z with each row backwards: as the scan runs where samples touch
  float apex_tolerance = 0;

  /// Sets a sample, k = row * stride + column.
  void lower(std::size_t k, float value) {
    z[k] = value;
    const auto row = k - k % static_cast<std::size_t>(stride);
    mirrored[row + static_cast<std::size_t>(width - 1) - k % static_cast<std::size_t>(stride)] =
        value;
  }
  float at(int i, int j) const { return z[static_cast<std::size_t>(j * stride + i)]; }
};

/// What one point of a scan demands of a tip.
class TipCarver {
 public:
  /// Lowers `demand` (like the tip's samples) to what point (x, y) allows, where that is below the
  /// tip by more than its threshold.
  void carve(const CarvedScan& scan, int x, int y, const CarvedTip& tip,
             std::vector<float>& demand);

 private:
  // Of each sample that can touch: tip - scan(x, y), or -infinity where the apex would stick out.
  std::vector<float> ways_;
  std::vector<float> allowed_;  // by the ways tried so far
};

}  // namespace surf
