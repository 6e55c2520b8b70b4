// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
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
  /// For arrays that are laid out like the scan: their size, and the place of (x, y).
  std::size_t size() const { return top_.size(); }
  const float* tops() const { return top_.data(); }
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>((y + margin_y_) * stride_ + x + margin_x_);
  }

 private:
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
  AlignedVector<float> mirrored;
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

/// Computes what points of a scan demand of a tip.
class TipCarver {
 public:
  /// Forgets what earlier points demanded. Then points may follow, all with this tip.
  void begin(const CarvedTip& tip);

  /// Lowers `limits()` to what point (x, y) of the scan allows. `apex` says how deep the apex can
  /// be at each place: laid out like the scan, as by `apex_heights`. It decides the order of the
  /// work, not the result.
  void carve(const CarvedScan& scan, const std::vector<float>& apex, int x, int y,
             const CarvedTip& tip);

  /// The least height that the points since `begin` allow each sample, laid out like the samples;
  /// the sample's height less its threshold where all of them allow that.
  const AlignedVector<float>& limits() const { return limits_; }

 private:
  AlignedVector<float> limits_;
  // Lists of vectors of samples; see the source.
  AlignedVector<float> ways_, open_;
  std::vector<std::int32_t> shifts_, places_, samples_;
};

}  // namespace surf
