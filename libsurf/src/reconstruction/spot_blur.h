// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"

namespace surf::reconstruction {

/// The range of `variance_px2` below: little sharpening, because it raises noise.
constexpr double least_blur_px2 = -0.4, largest_blur_px2 = 2;

/// An image whose spot is wider by a variance along each axis, in squared pixels: four passes of
/// (a, 1 - 2a, a) along each axis, which is a Gaussian but for its fourth moment. The image
/// continues by mirror. Linear and symmetric in the image; a negative variance sharpens.
Grid<double> blurred(const Grid<double>& image, double variance_px2);

/// The derivative of `blurred` by the variance.
Grid<double> change_of_blur(const Grid<double>& image, double variance_px2);

}  // namespace surf::reconstruction
