// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/placed_image.h"
#include "surf/reconstruction/reconstruct.h"
#include "surf/workflow/register_job.h"

namespace surf::workflow {

/// What the SEM image may be displaced by, in its pixels. None where the place is verified; in all
/// directions where rival places are not told from each other; along the motion that nothing holds,
/// by a tenth of the image, where the images slide on each other; towards the rivals, by as much at
/// most, where there are more of them than were judged.
PlaceDoubt place_doubt(const Pose& pose, const PlacedImage& sem);

/// By how many pixels that is along the direction in which it is most.
double largest_px(const PlaceDoubt& doubt);

}  // namespace surf::workflow
