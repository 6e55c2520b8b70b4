// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace surf {

/// How often each count 0, 1, 2, ... was seen.
using CountHistogram = std::vector<std::int64_t>;

struct CountMoments {
  std::int64_t trials = 0;
  double mean = 0;
  double variance = 0;  ///< unbiased; 0 for one trial
  double skewness = 0;  ///< 0 where all counts are equal
};

/// Chi-squared of a distribution: neighbouring counts are pooled until 25 trials are expected at
/// least.
struct CountFit {
  double chi_squared = 0;
  int degrees = 0;  ///< cells less 1 less parameters; 0: too few cells to tell
  double p = 1;     ///< chance of more
};

/// P(k) = exp(-mean) mean^k / k!.
struct PoissonCounts {
  double mean = 0;
  double probability(std::int64_t count) const;
};

/// A log-normal number, moved, rounded to the nearest whole number, and 0 where that is negative:
/// the count is max(0, round(median + scale (exp(shape z) - 1) / shape)) with z standard normal.
/// The thesis (8.2.2, figure 8-5) clamps negative values to 0 and says no more; a log-normal number
/// has some only if it is moved. With `shape` near 0 it is normal; it begins at median - scale /
/// shape.
struct LogNormalCounts {
  double median = 0;
  double scale = 1;  ///< > 0: standard deviation about the median, where the shape is small
  double shape = 0;  ///< >= 0: standard deviation of the logarithm
  double probability(std::int64_t count) const;
  double begin() const;  ///< minus infinity for shape 0
};

/// A normal number, rounded, and 0 where that is negative: what the SEM likelihood takes a pixel
/// for.
struct NormalCounts {
  double mean = 0, variance = 1;
  double probability(std::int64_t count) const;
};

CountMoments moments(const CountHistogram& counts);

/// The fits of greatest likelihood; the normal one has the counts' own mean and variance, less 1/12
/// for rounding where that leaves half of it. Throw InvalidInput for negative numbers, fewer than
/// 100 trials, or (but for Poisson) if all counts are equal.
PoissonCounts fit_poisson(const CountHistogram& counts);
LogNormalCounts fit_log_normal(const CountHistogram& counts);
NormalCounts fit_normal(const CountHistogram& counts);

/// The sum of log P(count).
double log_likelihood(const CountHistogram& counts, const LogNormalCounts& distribution);

CountFit test_fit(const CountHistogram& counts, const PoissonCounts& distribution);
CountFit test_fit(const CountHistogram& counts, const LogNormalCounts& distribution);
CountFit test_fit(const CountHistogram& counts, const NormalCounts& distribution);

}  // namespace surf
