// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// Noise of an SEM image: independent normal pixels whose variance is a line of their mean
/// (thesis, 8.2.2). Where the line falls below twice `least_variance` the variance leaves it
/// smoothly (a parabola, so that its derivative is continuous) and stays at `least_variance` from
/// where the line crosses 0: a fitted line may well be negative at dark pixels, and a variance may
/// not.
struct SemNoise {
  double slope = 0;               ///< variance per unit of intensity; may be negative
  double intercept = 1;           ///< variance at intensity 0; may be negative
  double least_variance = 1e-12;  ///< > 0

  double variance(double mean) const;
  /// Its derivative by the mean; continuous.
  double variance_slope(double mean) const;
};

/// Throws InvalidInput (naming `subject`) for numbers that are not finite or a least variance not
/// above 0.
void validate(const SemNoise& noise, const char* subject = "SEM noise");

/// The natural logarithm of the density of an image, given its mean at each pixel (thesis, 8.2.3):
/// the sum of -log(2 pi v) / 2 - (real - mean)^2 / (2 v). Pixels that are 0 in `used` (same size,
/// or empty) do not count. If `gradient` is given it becomes the derivative by each mean; if
/// `information` is given it becomes the expected negative second derivative, 1 / v + v'^2 / (2
/// v^2), 0 where a pixel does not count. Throws InvalidInput for sizes that differ and values that
/// are not finite.
double log_likelihood(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                      const Mask& used = {}, Grid<double>* gradient = nullptr,
                      Grid<double>* information = nullptr);

/// Residuals over their standard deviation; 0 where a pixel does not count.
Grid<double> whiten(const Grid<double>& real, const Grid<double>& mean, const SemNoise& noise,
                    const Mask& used = {});

}  // namespace surf
