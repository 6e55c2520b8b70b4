// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "surf/core/grid.h"

namespace surf {

/// A place between samples, and the weights of the 4 x 4 samples around it for cubic convolution
/// (Keys 1981, doi:10.1109/TASSP.1981.1163711), which reproduces parabolas and has continuous
/// derivatives. Beyond the border the outermost sample is repeated and its weights add up, so that
/// `scatter` is the exact transpose of `value`.
struct CubicSample {
  int column[4], row[4];
  double wx[4], wy[4];  ///< weights
  double dx[4], dy[4];  ///< derivatives of the weights by the place, per sample

  CubicSample(double x, double y, int width, int height) {
    set(x, width, column, wx, dx);
    set(y, height, row, wy, dy);
  }

  double value(const Grid<double>& z) const { return sum(z, wx, wy); }
  double slope_x(const Grid<double>& z) const { return sum(z, dx, wy); }
  double slope_y(const Grid<double>& z) const { return sum(z, wx, dy); }

  /// The transpose of `value`.
  void scatter(double weight, Grid<double>& out) const {
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) out(column[i], row[j]) += weight * wx[i] * wy[j];
  }

 private:
  double sum(const Grid<double>& z, const double* a, const double* b) const {
    double total = 0;
    for (int j = 0; j < 4; ++j) {
      double line = 0;
      for (int i = 0; i < 4; ++i) line += a[i] * z(column[i], row[j]);
      total += b[j] * line;
    }
    return total;
  }

  static void set(double at, int count, int* index, double* w, double* d) {
    const double cell = std::clamp(std::floor(at), 0.0, count - 2.0), t = at - cell;
    for (int k = 0; k < 4; ++k) index[k] = std::clamp(static_cast<int>(cell) + k - 1, 0, count - 1);
    w[0] = ((-0.5 * t + 1) * t - 0.5) * t;
    w[1] = (1.5 * t - 2.5) * t * t + 1;
    w[2] = ((-1.5 * t + 2) * t + 0.5) * t;
    w[3] = (0.5 * t - 0.5) * t * t;
    d[0] = (-1.5 * t + 2) * t - 0.5;
    d[1] = (4.5 * t - 5) * t;
    d[2] = (-4.5 * t + 4) * t + 0.5;
    d[3] = (1.5 * t - 1) * t;
  }
};

}  // namespace surf
