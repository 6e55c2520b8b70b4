// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placed_image.h"

namespace surf {

/// An image after a Gaussian blur of `blur_x`, `blur_y` samples (0: none). Invalid samples do not
/// contribute. Samples without valid samples nearby get the mean.
Grid<double> blurred(const PlacedImage& image, double blur_x, double blur_y);

/// A cubic spline through the samples of an image (Unser 1999, doi:10.1109/79.799930). Its slopes
/// have no kinks, which would attract optima to the samples.
class SmoothImage {
 public:
  struct Value {
    double value = 0, dx = 0, dy = 0;  ///< slopes per sample
  };

  SmoothImage() = default;
  /// Places in x and y are (column - middle) * step; blurs are in the unit of `step`. Samples whose
  /// blur reaches beyond the image count too, although their blurred values are shifted a little
  /// inward. The rim determines rotations and scales best, and errors are larger without it.
  SmoothImage(const PlacedImage& image, double step_x, double step_y, double blur);

  /// Whether the place lies between valid samples.
  bool holds(double x, double y) const {
    const double u = column(x), v = row(y);
    if (!(u >= 0 && v >= 0 && u <= coefficients_.width() - 3 && v <= coefficients_.height() - 3))
      return false;
    return safe_.empty() || safe_(static_cast<int>(u), static_cast<int>(v)) != 0;
  }

  /// Value and slopes at a place, per unit of x and y. Beyond the image the values of its edge are
  /// used.
  Value at(double x, double y) const;
  double value(double x, double y) const;

  const Grid<double>& samples() const { return samples_; }  ///< blurred
  bool is_valid(int column, int row) const { return valid_.includes(column, row); }
  double column(double x) const { return x / step_x_ + middle_x_; }
  double row(double y) const { return y / step_y_ + middle_y_; }
  double half_width() const { return middle_x_ * step_x_; }
  double half_height() const { return middle_y_ * step_y_; }

 private:
  double step_x_ = 1, step_y_ = 1, middle_x_ = 0, middle_y_ = 0;
  Grid<double> samples_;
  Grid<double> coefficients_;  // with one more sample on each side
  Mask valid_, safe_;          // valid samples, and cells between four valid ones; empty: all
};

}  // namespace surf
