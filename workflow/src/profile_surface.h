// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/profile_job.h"

namespace surf::workflow {

/// The surface of a fitted shape on an image's pixels, lines along y, and the standard deviation of
/// its heights: by the places of edges in each row, the height, angle and corners. Also the image
/// as the fit has it, and the edges' places in it.
void add_surface(const PlacedImage& image, ProfileSummary& summary);

/// Exchanges x and y of what `add_surface` adds.
void turn_surface(ProfileSummary& summary);

/// The height of walls in a scan, from its lower level to its upper one, and its standard error.
/// Throws InvalidInput if there are no two levels.
Measured wall_height(const HeightField& scan);

}  // namespace surf::workflow
