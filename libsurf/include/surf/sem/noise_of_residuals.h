// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/mask.h"
#include "surf/sem/sem_noise.h"

namespace surf {

/// Estimates the line of an image's noise, given the values of a rough model. Errors of the model
/// count as noise less than in `fit_sem_noise`: second differences of the residuals along rows
/// remove slow errors, and the medians of these over 30 bins of pixels with similar means remove
/// rare errors. Bins farther than 3.5 standard errors from the line are left out. Pixels are
/// assumed independent; noise that is correlated along rows is underestimated. Pixels that are 0 in
/// `used` (same size, or empty) and their neighbours do not count. If the slope is within two of
/// its standard errors of 0, the variance is constant. Throws InvalidInput for sizes that differ,
/// values that are not finite, fewer than 100 second differences, or if half of them are 0.
SemNoise noise_of_residuals(const Grid<double>& real, const Grid<double>& mean,
                            const Mask& used = {});

}  // namespace surf
