// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/placed_image.h"

namespace surf {

/// A shift of one image over another where they agree.
struct ImageShift {
  double x_nm = 0, y_nm = 0;  ///< to add to places of the moving image
  double correlation = 0;     ///< -1 to 1
};

/// Shifts by whole pixels where two images of the same pixel size agree best, best first, by the
/// normalised correlation of what overlaps: at least `least_overlap` of the smaller one. Throws
/// InvalidInput for other pixel sizes.
std::vector<ImageShift> find_shifts(const PlacedImage& resting, const PlacedImage& moving,
                                    int count = 8, double least_overlap = 0.4);

}  // namespace surf
