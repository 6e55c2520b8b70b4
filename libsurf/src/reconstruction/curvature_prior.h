// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"

namespace surf::reconstruction {

/// The prior of the surface. Its second derivatives follow Student's t with `degrees` degrees of
/// freedom and the scale `curvature_per_nm`, so that the surface is smooth unless the data
/// contradict, and edges cost little. With c^2 = z_xx^2 + z_yy^2 + 2 z_xy^2 at each sample, -log p
/// = sum of (degrees + 1) / 2 log(1 + c^2 / (degrees curvature^2)). At the border, derivatives that
/// need samples beyond it do not count.
class CurvaturePrior {
 public:
  static constexpr double degrees = 1;

  CurvaturePrior(double pitch_nm, double curvature_per_nm)
      : pitch_nm_(pitch_nm), curvature_(curvature_per_nm) {}

  /// The value of the prior's term. If given, `gradient` is increased by its derivative, and
  /// `weights` is set to its derivative by each sample's c^2 / 2.
  double evaluate(const Grid<double>& z_nm, Grid<double>* gradient, Grid<double>* weights) const;

  double curvature_per_nm() const { return curvature_; }

  /// The scale that maximises the likelihood of the heights. The density of all curvatures contains
  /// the scale to the power of the number of samples, so at the maximum the mean of c^2 / (degrees
  /// curvature^2 + c^2) is 1 / (degrees + 1). The scale is about the median curvature, and nearly 0
  /// if most of the specimen consists of plateaus. At least 1e-9.
  double likely_curvature_per_nm(const Grid<double>& z_nm) const;

  /// c^2 of each sample.
  Grid<double> squared_curvature(const Grid<double>& z_nm) const;
  /// The weights that `evaluate` gives for these squared curvatures.
  Grid<double> weights_of(const Grid<double>& squared_curvature) const;

  /// Adds the product of the quadratic form of these weights and dz to `out`.
  void add_product(const Grid<double>& weights, const Grid<double>& dz_nm, Grid<double>& out) const;

  /// Calls entry(x, y, count, dx, dy, coefficients, weight) for each squared second difference of
  /// the quadratic form. The form is the sum over all calls of weight * (sum of coefficient * z)^2.
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
  // Twice the mean of the weights of a cell's four corners: `evaluate` shares a cell's mixed
  // difference between its corners.
  static double cell_weight(const Grid<double>& w, int x, int y) {
    return 0.5 * (w(x, y) + w(x + 1, y) + w(x, y + 1) + w(x + 1, y + 1));
  }

  double pitch_nm_, curvature_;
};

}  // namespace surf::reconstruction
