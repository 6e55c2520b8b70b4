// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/noise.h"
#include "surf/core/grid.h"

namespace surf {

/// e' R^-1 e of residuals under a noise model, and R^-1 e in `gradient`; rows are independent, and so are
/// what a hole divides.
inline double afm_misfit(const Grid<double>& e, const Grid<unsigned char>& valid, const AfmNoise& noise,
                         Grid<double>& gradient) {
  gradient = Grid<double>(e.width(), e.height());
  const double a = noise.alpha, of_v = 1 / noise.innovation_nm2;
  double sum = 0;
  for (int y = 0; y < e.height(); ++y)
    for (int x = 0; x < e.width(); ++x) {
      if (!valid(x, y)) continue;
      if (x == 0 || !valid(x - 1, y)) {
        const double w = (1 - a * a) * of_v;
        sum += w * e(x, y) * e(x, y);
        gradient(x, y) += w * e(x, y);
        continue;
      }
      const double v = e(x, y) - a * e(x - 1, y);
      sum += of_v * v * v;
      gradient(x, y) += of_v * v;
      gradient(x - 1, y) -= a * of_v * v;
    }
  return sum;
}

}  // namespace surf
