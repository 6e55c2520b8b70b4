// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/grid.h"

namespace surf::reconstruction {

/// Sums of Gaussians of one width, one Gaussian at each sample: h = C * G (thesis, 9.1). Beyond the
/// border the coefficients are mirrored, so that constants stay constant. The samples of G add up
/// to 1.
class GaussianBasis {
 public:
  GaussianBasis(double sigma_px, int threads);

  Grid<double> sum(const Grid<double>& coefficients) const;   ///< C * G
  Grid<double> transpose(const Grid<double>& weights) const;  ///< the exact adjoint of `sum`

  /// Coefficients whose sum approximates `heights`, by Van Cittert's iteration C += relaxation
  /// (heights - C * G) (thesis, 9.4). It ends when the largest residual is below `tolerance`, or
  /// after `iterations`.
  Grid<double> deconvolved(const Grid<double>& heights, double tolerance, int iterations,
                           double relaxation = 1) const;

 private:
  std::vector<double> half_;  // weights at distances of 0, 1, 2 ... samples
  int threads_;
};

}  // namespace surf::reconstruction
