// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// Correlation about the mean of samples that are `lag` columns (or rows) apart.
struct LagCorrelation {
  int lag = 0;
  double correlation = 0;  ///< in about [-1, 1]
  double z = 0;            ///< correlation * sqrt(number of pairs): standard normal if white
};

struct NoiseCheckOptions {
  int lags = 10;  ///< along and across rows, >= 1; fewer where the image is smaller
  /// Number of correlation parameters fitted to the same data; each costs a degree of freedom.
  int fitted_parameters = 1;
};

/// How far whitened residuals are from white and normal.
struct NoiseCheck {
  std::size_t samples = 0;
  /// Of the whitened residuals; 0 and 1 if the model is right.
  double mean = 0, standard_deviation = 0;
  std::vector<LagCorrelation> along, across;
  /// The sums of z^2 over the lags, which is the statistic of Ljung and Box (1978,
  /// doi:10.1093/biomet/65.2.297) for many short rows, and the probability (chi-squared) of a
  /// larger sum if the residuals are white.
  double along_q = 0, along_p = 1, across_q = 0, across_p = 1;
  double skewness = 0, excess_kurtosis = 0;
  /// The statistic of Jarque and Bera, with each term divided by its exact variance for this number
  /// of samples (Urzua 1996, doi:10.1016/S0165-1765(96)00923-8), and the probability of a larger
  /// one (chi-squared, two degrees of freedom).
  double jarque_bera = 0, normal_p = 1;
};

/// Tests whitened residuals. With many samples the smallest deviation is significant, so look at
/// the correlations themselves too. Samples that are 0 in `valid` (same size, or empty) do not
/// count. Throws InvalidInput if the mask has another size, a sample is not finite, fewer than 16
/// samples remain, or all are equal.
NoiseCheck check_noise(const Grid<double>& whitened, const Mask& valid = {},
                       const NoiseCheckOptions& options = {});

/// The autocovariance of a residual about 0 along rows, for lags 0 to `lags`, in squared units of
/// the residual. Lags without a pair give 0.
std::vector<double> autocovariance(const Grid<double>& residual, int lags, const Mask& valid = {});

/// The probability that a chi-squared number with `degrees` (>= 1) degrees of freedom exceeds `x`.
double chi_squared_tail(double x, int degrees);

}  // namespace surf
