// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "registration/overlap.h"

namespace surf {

/// What correlates badly, as least squares. With a the SEM's and b the AFM's intensities over a
/// fixed set of samples, each less its mean and over its norm, and r = max(0, a . b) their
/// correlation, the residuals a - r b have the squared norm 1 - r^2, which is least where the
/// correlation is largest; their derivatives by the corners are exact. Samples that leave the AFM's
/// image see its edge.
class Correlation {
 public:
  /// The samples as they overlap under `corners`.
  Correlation(const BlurLevel& level, const Corners& corners);

  std::size_t size() const { return overlap_.size(); }
  const std::vector<std::size_t>& overlap() const { return overlap_; }
  const std::vector<double>& sem() const { return a_; }  ///< normalised

  /// Residuals, and if wanted their derivatives by each corner, one column of `size()` after the
  /// other. Returns the correlation; 0 and zeros where the AFM's image is of one colour.
  double evaluate(const double* corners, double* residuals, double* jacobian) const;

  /// Of half the residuals' squared norm by the corners, quicker than by `evaluate`; zeros where
  /// the intensities do not rise together.
  Corners gradient(const Corners& corners) const;

 private:
  const BlurLevel& level_;
  std::vector<std::size_t> overlap_;
  std::vector<double> a_;
};

/// First and second derivatives of half the residuals' squared norm by the corners; the second by
/// central differences of the exact first, so that noise in the AFM's image is not taken for
/// structure.
struct Slopes {
  Corners first{};
  std::array<double, 36> second{};
};
Slopes slopes_at(const Correlation& correlation, const Corners& corners);

struct CorrelationFit {
  Corners corners{};
  Agreement agreement;  ///< at the end, over all that overlaps there
  int evaluations = 0;
  bool settled = false;  ///< the last steps moved nothing by more than a thousandth of a pixel
};

/// Largest correlation from a start on, by Levenberg and Marquardt's method; the overlap is renewed
/// up to `rounds` times. Then at least one and at most so many of Newton's steps, if any are
/// wanted.
CorrelationFit fit_correlation(const BlurLevel& level, const Corners& start, int rounds,
                               int iterations, int newton_steps);

}  // namespace surf
