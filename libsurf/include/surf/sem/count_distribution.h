// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace surf {

/// The number of times that each count 0, 1, 2, ... was observed.
using CountHistogram = std::vector<std::int64_t>;

struct CountMoments {
  std::int64_t trials = 0;
  double mean = 0;
  double variance = 0;  ///< unbiased; 0 for one trial
  double skewness = 0;  ///< 0 if all counts are equal
};

/// A chi-squared test. Neighbouring counts are pooled until at least 25 trials are expected.
struct CountFit {
  double chi_squared = 0;
  int degrees = 0;  ///< cells - 1 - parameters; 0: too few cells to tell
  double p = 1;     ///< probability of a larger chi-squared
};

/// P(k) = exp(-mean) mean^k / k!.
struct PoissonCounts {
  double mean = 0;
  double probability(std::int64_t count) const;
};

/// A shifted log-normal number, rounded to the nearest whole number; negative numbers become 0. The
/// count is max(0, round(median + scale (exp(shape z) - 1) / shape)) with z standard normal. The
/// thesis (8.2.2, figure 8-5) sets negative values to 0 and says no more; a log-normal number can
/// be negative only if it is shifted. The distribution begins at median - scale / shape; for
/// `shape` near 0 it is normal.
struct LogNormalCounts {
  double median = 0;
  double scale = 1;  ///< > 0: standard deviation about the median if the shape is small
  double shape = 0;  ///< >= 0: standard deviation of the logarithm
  double probability(std::int64_t count) const;
  double begin() const;  ///< lower end; minus infinity for shape 0
};

/// A rounded normal number; negative numbers become 0. The SEM likelihood assumes this distribution
/// for a pixel.
struct NormalCounts {
  double mean = 0, variance = 1;
  double probability(std::int64_t count) const;
};

CountMoments moments(const CountHistogram& counts);

/// Maximum-likelihood fits. The normal distribution instead has the mean and variance of the
/// counts; 1/12 is subtracted from the variance for the rounding, if at least half of the variance
/// remains. All throw InvalidInput for negative numbers of observations, for fewer than 100 trials,
/// and (except Poisson) if all counts are equal.
PoissonCounts fit_poisson(const CountHistogram& counts);
LogNormalCounts fit_log_normal(const CountHistogram& counts);
NormalCounts fit_normal(const CountHistogram& counts);

/// The sum of log P(count).
double log_likelihood(const CountHistogram& counts, const LogNormalCounts& distribution);

CountFit test_fit(const CountHistogram& counts, const PoissonCounts& distribution);
CountFit test_fit(const CountHistogram& counts, const LogNormalCounts& distribution);
CountFit test_fit(const CountHistogram& counts, const NormalCounts& distribution);

}  // namespace surf
