// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/image.h"
#include "surf/mc/scene.h"

namespace surf::mc {

/// What the middle of each pixel's beam meets first, placed as `make_image` does. Channels:
///   z_nm                             height, nm
///   normal.x, normal.y, normal.z     unit normal of the triangle, out of the solid
///   material                         1 + index into `Scene::materials()`
/// All are 0 where the beam meets nothing; the channel valid is 0 there and 1 elsewhere.
Image surface_view(const Scene& scene, int threads = 0);

}  // namespace surf::mc
