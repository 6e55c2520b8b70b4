// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"

namespace surf::reconstruction {

/// What is expected of a surface before it is imaged: its second derivatives are Student's t with
/// `degrees` degrees of freedom and the scale `curvature_per_nm`, so that it is smooth where
/// nothing speaks against it and edges cost little. With c^2 = z_xx^2 + z_yy^2 + 2 z_xy^2 at each
/// sample, -log p = sum of (degrees + 1) / 2 log(1 + c^2 / (degrees curvature^2)). At the border,
/// derivatives that need samples beyond it do not count.
class CurvaturePrior {
 public:
  static constexpr double degrees = 1;

  CurvaturePrior(double pitch_nm, double curvature_per_nm)
      : pitch_nm_(pitch_nm), curvature_(curvature_per_nm) {}

  /// The prior's term. `gradient` (if given) gets its derivative added; `weights` that of each
  /// sample's c^2 / 2.
  double evaluate(const Grid<double>& z_nm, Grid<double>* gradient, Grid<double>* weights) const;

  double curvature_per_nm() const { return curvature_; }

  /// The scale under which heights are most likely: as the density of all curvatures goes with the
  /// number of samples' power of it, the mean of c^2 / (degrees curvature^2 + c^2) is 1 / (degrees
  /// + 1) there. About the median curvature: next to nothing where most of the specimen is
  /// plateaus. 1e-9 at least.
  double likely_curvature_per_nm(const Grid<double>& z_nm) const;

  /// c^2 of each sample.
  Grid<double> squared_curvature(const Grid<double>& z_nm) const;
  /// What `evaluate` gives as weights, of curvatures whose squares are these.
  Grid<double> weights_of(const Grid<double>& squared_curvature) const;

  /// out += the quadratic form of these weights, times dz.
  void add_product(const Grid<double>& weights, const Grid<double>& dz_nm, Grid<double>& out) const;

  /// Calls entry(x, y, [offsets and coefficients]) for each squared second difference of the
  /// quadratic form: the form is the sum over calls of weight * (sum of coefficient * z)^2.
  template <class Entry>
  void for_each_difference(const Grid<double>& weights, const Entry& entry) const {
    const double f = 1 / (pitch_nm_ * pitch_nm_);
    const int w = weights.width(), h = weights.height();
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        if (x > 0 && x + 1 < w) {
          const int dx[3] = {-1, 0, 1}, dy[3] = {0, 0, 0};
          const double c[3] = {f, -2 * f, f};
          entry(x, y, 3, dx, dy, c, weights(x, y));
        }
        if (y > 0 && y + 1 < h) {
          const int dx[3] = {0, 0, 0}, dy[3] = {-1, 0, 1};
          const double c[3] = {f, -2 * f, f};
          entry(x, y, 3, dx, dy, c, weights(x, y));
        }
        if (x + 1 < w && y + 1 < h) {
          const int dx[4] = {0, 1, 0, 1}, dy[4] = {0, 0, 1, 1};
          const double c[4] = {f, -f, -f, f};
          entry(x, y, 4, dx, dy, c, cell_weight(weights, x, y));
        }
      }
  }

 private:
  // Twice the mean over the four corners of a quarter of their weights... see evaluate: a cell's
  // mixed difference is shared by its corners.
  static double cell_weight(const Grid<double>& w, int x, int y) {
    return 0.5 * (w(x, y) + w(x + 1, y) + w(x, y + 1) + w(x + 1, y + 1));
  }

  double pitch_nm_, curvature_;
};

}  // namespace surf::reconstruction
