// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/image_rows.h"
#include "surf/mc/geometry/scene.h"

namespace surf::mc {

/// What the middle of each pixel's beam meets first, placed as `make_image` does. Channels:
///   z_nm                             height, nm
///   normal.x, normal.y, normal.z     unit normal of the triangle, out of the solid
///   material                         1 + index into `Scene::materials()`
/// All are 0 where the beam meets nothing; the channel valid is 0 there and 1 elsewhere.
Image surface_view(const Scene& scene, int threads = 0);

/// Only the channels of these names, row by row; in scratch files where `scratch_folder` is named
/// (see LargeGrid). Throws UsageError for a name that is not among the above.
ImageRows surface_view_rows(const Scene& scene, const std::vector<std::string>& channels,
                            int threads, const std::string& scratch_folder);

}  // namespace surf::mc
