// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/mask.h"
#include "surf/sem/sem_noise.h"

namespace surf {

/// The line of an image's noise, given what a rough model says of each pixel: less of what the
/// model is off by counts as noise than for `fit_sem_noise`. Slow misfits leave the second
/// differences of the residuals along rows, rare ones the medians of these over 30 bins of pixels
/// of neighbouring means, and bins farther than 3.5 standard errors from the line are left out.
/// Pixels are taken as independent: noise that is correlated along rows comes out too small. Pixels
/// that are 0 in `used` (same size, or empty) and their neighbours do not count. Where the slope is
/// within two of its standard errors of 0, the variance is constant. Throws InvalidInput for sizes
/// that differ, values that are not finite, or fewer than 100 second differences that are not 0.
SemNoise noise_of_residuals(const Grid<double>& real, const Grid<double>& mean,
                            const Mask& used = {});

}  // namespace surf
