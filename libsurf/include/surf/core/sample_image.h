// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/placed_image.h"

namespace surf {

/// The bilinear interpolation of an image at a place in its frame, nm. NaN beyond the centres of
/// the outermost samples, and where a sample with non-zero weight is a hole.
double sample_image(const PlacedImage& image, Point2 place_nm);

}  // namespace surf
