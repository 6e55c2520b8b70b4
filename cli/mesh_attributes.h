// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/surface.h"
#include "surf/workflow/picture_input.h"

namespace surf::cli {

/// "height" and "curvature" (surf/mesh/vertex_curvature.h) for every surface that does not have
/// them. The curvature of what `solid` adds is 0.
void add_shape_scalars(SurfaceScene& scene, const Watch& watch);

/// A channel of an image or scan as a scalar of every surface. Its name, which is made unique, is
/// the channel's in the form of `VertexScalar`. Throws InvalidInput where it is not known under
/// some vertex of one.
void add_image_scalar(const workflow::FileChannel& input, const workflow::GivenPitch& pitch,
                      SurfaceScene& scene);

/// A picture onto every surface that it lies over. Throws InvalidInput if there is none.
void add_drape(const workflow::FileChannel& input, const workflow::GivenPitch& pitch,
               SurfaceScene& scene);

}  // namespace surf::cli
