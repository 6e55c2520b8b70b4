// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Mean curvature at every vertex, 1/nm: positive where the surface bulges outwards (a ball of
/// radius R has 1/R), from the quadric in the vertex's tangent frame that fits best the vertices up
/// to two edges away, of the second those that face its way (least squares, Cazals and Pouget 2005,
/// doi:10.1016/j.cagd.2004.09.004). Exact on quadrics seen along their axis; where vertices are too
/// few to tell, the flattest quadric. 0 at vertices without triangles. At edges and corners, whose
/// curvature is infinite, it is that of a rounding as wide as the neighbourhood. Equal vertices
/// count as one. The same for any number of `threads` (0: one per hardware thread). Throws
/// InvalidInput on damaged meshes, Interrupted.
std::vector<float> mean_curvature(const TriangleMesh& mesh, int threads = 0,
                                  const Watch& watch = {});

}  // namespace surf
