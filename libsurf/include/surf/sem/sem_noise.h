// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// Noise of an SEM image: independent normal pixels whose variance is a linear function of their
/// mean (thesis, 8.2.2). A fitted line may be negative at dark pixels, but a variance may not.
/// Therefore the variance departs from the line smoothly where the line falls below twice
/// `least_variance` (a parabola, so that the derivative is continuous), and is `least_variance`
/// where the line is negative.
struct SemNoise {
  double slope = 0;               ///< variance per unit of intensity; may be negative
  double intercept = 1;           ///< variance at intensity 0; may be negative
  double least_variance = 1e-12;  ///< > 0

  double variance(double mean) const;
  /// The derivative of the variance by the mean; continuous.
  double variance_slope(double mean) const;
};

/// Throws InvalidInput (naming `subject`) for numbers that are not finite and a least variance that
/// is not above 0.
void validate(const SemNoise& noise, const char* subject = "SEM noise");

/// The natural logarithm of the density of an image, given its mean at each pixel (thesis, 8.2.3):
/// the sum of -log(2 pi v) / 2 - (real - mean)^2 / (2 v). Pixels that are 0 in `used` (same size,
/// or empty) do not count. If given, `gradient` is set to the derivative by each mean, and
/// `information` to the expected negative second derivative, 1 / v + v'^2 / (2 v^2); both are 0 for
/// pixels that do not count. Throws InvalidInput for sizes that differ and values that are not
/// finite.
double log_likelihood(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                      const Mask& used = {}, Grid<double>* gradient = nullptr,
                      Grid<double>* information = nullptr);

/// Residuals divided by their standard deviation; 0 for pixels that do not count.
Grid<double> whiten(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                    const Mask& used = {});

}  // namespace surf
