// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/grid.h"

namespace surf {

/// A scan prepared for carving: heights as floats between a bottom that places tips and a top that
/// carves them, with a margin in which everything is allowed.
class CarvedScan {
 public:
  /// Heights that are not finite are holes. `layer` is added to the top and taken from the bottom.
  CarvedScan(const Grid<float>& heights, double layer, int tip_width, int tip_height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// The top of the layer: +infinity in holes, and beyond the border up to a distance of the tip's
  /// size.
  const float* top(int x, int y) const { return &top_[offset(x, y)]; }
  /// The bottom of the layer: -infinity in holes.
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
  std::vector<float> z, threshold;  ///< a sample is lowered only by more than its threshold
  /// z with each row reversed, which is the order of the scan's samples at contact.
  std::vector<float> mirrored;
  float apex_tolerance = 0;

  /// Sets sample k = row * stride + column.
  void lower(std::size_t k, float value) {
    z[k] = value;
    const auto row = k - k % static_cast<std::size_t>(stride);
    mirrored[row + static_cast<std::size_t>(width - 1) - k % static_cast<std::size_t>(stride)] =
        value;
  }
  float at(int i, int j) const { return z[static_cast<std::size_t>(j * stride + i)]; }
};

/// Computes the demands of one point of a scan on a tip.
class TipCarver {
 public:
  /// Lowers `demand` (laid out like the tip's samples) to what point (x, y) allows, for samples
  /// that are higher than that by more than their threshold.
  void carve(const CarvedScan& scan, int x, int y, const CarvedTip& tip,
             std::vector<float>& demand);

 private:
  // For each sample that can touch: tip - scan(x, y); -infinity if the apex would penetrate the
  // scan.
  std::vector<float> ways_;
  std::vector<float> allowed_;  // the height that the contacts tried so far allow
};

}  // namespace surf
