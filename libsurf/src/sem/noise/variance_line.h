// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace surf {

/// A variance at an intensity, estimated with `freedom` degrees of freedom.
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
  double cut = 0;         ///< points beyond this many standard errors are left out; 0: all count
};

/// The most likely line through variances with chi-squared errors: weights freedom / (2 v^2) with v
/// from the line itself, iterated. Where the variance departs from the line (SemNoise), the weights
/// are those of the likelihood. With `cut`, the iteration begins at the line through medians of
/// groups of points, so that up to half of the points may be far too large. Needs at least one
/// point; if all means are equal, the slope is 0.
VarianceLine fit_variance_line(const std::vector<VariancePoint>& points,
                               const VarianceLineOptions& options);

/// The deviation of a variance from the expected one, as a standard normal number (Wilson and
/// Hilferty 1931).
double score(const VariancePoint& point, double expected);

/// The result of fitting a parabola instead of a line; 0 if it is not determined.
struct Curvature {
  double z = 0;  ///< coefficient of the parabola over its standard error
  /// Largest difference from the line, at either end or the middle, over the line's variance there.
  double departure = 0;
};
Curvature fit_curvature(const std::vector<VariancePoint>& points, const VarianceLine& line,
                        double floor);

}  // namespace surf
