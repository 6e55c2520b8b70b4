// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/placed_image.h"

namespace surf {

/// The value at a place in the image's frame, nm, in proportion to the four samples around. NaN
/// beyond the centres of the outermost samples and where one of those that count is a hole.
double sample_image(const PlacedImage& image, Point2 place_nm);

}  // namespace surf
