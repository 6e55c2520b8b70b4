// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace surf {

/// A variance estimated with `freedom` degrees of freedom, at an intensity.
struct VariancePoint {
  double mean = 0, variance = 0;
  double freedom = 1;  ///< > 0: the variance's own variance is 2 v^2 / freedom
};

struct VarianceLine {
  double slope = 0, intercept = 0;
  std::array<double, 4> covariance{};  ///< of slope and intercept, row-major
  std::vector<char> used;              ///< one per point
};

struct VarianceLineOptions {
  bool constant = false;  ///< slope 0
  double floor = 1e-12;   ///< SemNoise::least_variance, > 0
  double cut = 0;         ///< points beyond so many standard errors are left out; 0: all count
};

/// The most likely line through variances whose errors are those of chi-squared: weights freedom /
/// (2 v^2) with v of the line itself, iterated; where the variance leaves the line (SemNoise), the
/// likelihood's. With `cut` it begins at the line through medians of groups of points, so that up
/// to half of them may be far too large. At least one point; with one mean only the slope is 0.
VarianceLine fit_variance_line(const std::vector<VariancePoint>& points,
                               const VarianceLineOptions& options);

/// How far a variance is from the one expected, as a standard normal number (Wilson and Hilferty
/// 1931).
double score(const VariancePoint& point, double expected);

/// Of a parabola that is fitted in place of the line; 0 where it cannot be told.
struct Curvature {
  double z = 0;          ///< its coefficient over the standard error
  double departure = 0;  ///< the most it is off the line at either end or the middle, over the
                         ///< line's variance there
};
Curvature fit_curvature(const std::vector<VariancePoint>& points, const VarianceLine& line,
                        double floor);

}  // namespace surf
