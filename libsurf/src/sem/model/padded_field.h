// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/edge.h"
#include "surf/core/height_field.h"

namespace surf {

/// Heights with their continuation, and slopes by central differences. Places count from the
/// field's lower left sample and begin at -margin; slopes need one more sample around.
class PaddedField {
 public:
  /// `margin` >= 1 samples on each side.
  PaddedField(const HeightField& field, int margin, Edge edge);

  int width() const { return width_; }
  int height() const { return height_; }
  double z(int x, int y) const { return z_(x + margin_, y + margin_); }
  double slope_x(int x, int y) const { return (z(x + 1, y) - z(x - 1, y)) * per_two_x_; }
  double slope_y(int x, int y) const { return (z(x, y + 1) - z(x, y - 1)) * per_two_y_; }

  /// Other heights of the same size, with the same continuation.
  PaddedField like(const Grid<double>& z_nm) const;

  /// A grid of zeros of the padded size, and access to such grids by place.
  Grid<double> none() const { return Grid<double>(z_.width(), z_.height()); }
  double& at(Grid<double>& padded, int x, int y) const { return padded(x + margin_, y + margin_); }

  /// The transpose: converts derivatives by heights and slopes at all places to derivatives by the
  /// field's own heights. Derivatives by slopes must be 0 in the outermost samples.
  Grid<double> fold(Grid<double> by_z, const Grid<double>& by_slope_x,
                    const Grid<double>& by_slope_y) const;

 private:
  void fill(const Grid<double>& z_nm);

  int width_, height_, margin_;
  double per_two_x_, per_two_y_;      // 1 / (2 pitch)
  std::vector<int> from_x_, from_y_;  // source columns and rows of the padded ones
  Grid<double> z_;
};

}  // namespace surf
