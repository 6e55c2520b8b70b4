// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// Correlation of samples that are `lag` columns (or rows) apart, about the mean.
struct LagCorrelation {
  int lag = 0;
  double correlation = 0;  ///< in about [-1, 1]
  double z = 0;  ///< times the square root of the number of pairs: standard normal if white
};

struct NoiseCheckOptions {
  int lags = 10;  ///< along and across rows, >= 1; fewer where the image is smaller
  int fitted_parameters =
      1;  ///< of correlation, fitted to the same data: they cost degrees of freedom
};

/// Whether whitened residuals are white and normal, and how far from it.
struct NoiseCheck {
  std::size_t samples = 0;
  double mean = 0,
         standard_deviation = 0;  ///< of the whitened residuals: 0 and 1 if the model is right
  std::vector<LagCorrelation> along, across;
  /// Sums of z^2 over the lags: the statistic of Ljung and Box (1978, doi:10.1093/biomet/65.2.297)
  /// for many short rows; and the chance of a larger one if the residuals are white (chi-squared).
  double along_q = 0, along_p = 1, across_q = 0, across_p = 1;
  double skewness = 0, excess_kurtosis = 0;
  /// The statistic of Jarque and Bera, each term divided by its exact variance for this number of
  /// samples (Urzua 1996, doi:10.1016/S0165-1765(96)00923-8), and the chance of a larger one
  /// (chi-squared, two degrees).
  double jarque_bera = 0, normal_p = 1;
};

/// With many samples the smallest deviation is significant: look at the correlations themselves
/// too. Samples that are 0 in `valid` (same size, or empty) take no part. Throws InvalidInput if
/// the mask has another size, a sample is not finite, fewer than 16 remain, or all are equal.
NoiseCheck check_noise(const Grid<double>& whitened, const Mask& valid = {},
                       const NoiseCheckOptions& options = {});

/// The autocovariance along rows of a residual about 0, lags 0 to `lags`, in its unit squared.
/// Lags without a pair give 0.
std::vector<double> autocovariance(const Grid<double>& residual, int lags, const Mask& valid = {});

/// The chance that chi-squared with `degrees` (>= 1) exceeds `x`.
double chi_squared_tail(double x, int degrees);

}  // namespace surf
