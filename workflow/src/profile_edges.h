// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/placed_image.h"
#include "surf/profile/fit_profile.h"

namespace surf::workflow {

/// All edges that an image shows or whose walls reach into it, across lines that run along y:
/// - those that were fitted,
/// - those of walls whose features the image cuts off, by their rims: as far from them as fitted
///   edges are from theirs, straight,
/// - at each end the next one, where the end would hide its rim: by the pitch, straight. A pitch of
///   0 is none.
/// `fitted` must not be empty.
std::vector<FittedEdge> edges_in_sight(const PlacedImage& image,
                                       const std::vector<WallRim>& cut_off,
                                       const std::vector<FittedEdge>& fitted, Measured pitch_nm);

}  // namespace surf::workflow
