// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "registration/overlap.h"

namespace surf {

/// Correlation as a least-squares problem. Let a be the SEM's and b the AFM's intensities over a
/// fixed set of samples, each minus its mean and divided by its norm, and r = max(0, a . b) their
/// correlation. The residuals a - r b have the squared norm 1 - r^2, which is smallest where the
/// correlation is largest. Their derivatives by the corners are exact. Samples outside the AFM's
/// image get the value of its edge.
class Correlation {
 public:
  /// Uses the samples that overlap under `corners`.
  Correlation(const BlurLevel& level, const ThreePointMap& corners);

  std::size_t size() const { return overlap_.size(); }
  const std::vector<std::size_t>& overlap() const { return overlap_; }
  const std::vector<double>& sem() const { return a_; }  ///< normalised

  /// Computes the residuals and, if wanted, their derivatives by each corner (one column of
  /// `size()` after the other). Returns the correlation; 0 and zeros if the AFM's image is of one
  /// colour.
  double evaluate(const double* corners, double* residuals, double* jacobian) const;

  /// The gradient of half the squared norm of the residuals by the corners, faster than with
  /// `evaluate`. Zeros if the intensities do not rise together.
  ThreePointMap gradient(const ThreePointMap& corners) const;

 private:
  const BlurLevel& level_;
  std::vector<std::size_t> overlap_;
  std::vector<double> a_;
};

/// First and second derivatives of half the squared norm of the residuals by the corners. The
/// second derivatives are central differences of the exact first ones, so that noise in the AFM's
/// image is not mistaken for structure.
struct Slopes {
  ThreePointMap first{};
  std::array<double, 36> second{};
};
Slopes slopes_at(const Correlation& correlation, const ThreePointMap& corners);

struct CorrelationFit {
  ThreePointMap corners{};
  Agreement agreement;  ///< at the result, over all samples that overlap there
  int evaluations = 0;
  /// The last step moved every corner by less than 0.002 pixels times the stride of the samples.
  bool settled = false;
};

/// Maximises the correlation from an initial map, by Levenberg and Marquardt's method; the overlap
/// is updated up to `rounds` times. If `newton_steps` is above 0, at least one and at most
/// `newton_steps` Newton steps follow.
CorrelationFit fit_correlation(const BlurLevel& level, const ThreePointMap& start, int rounds,
                               int iterations, int newton_steps);

}  // namespace surf
