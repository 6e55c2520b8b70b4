// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Mean curvature at every vertex, 1/nm: positive where the surface bulges outwards (1/R on a ball
/// of radius R). It comes from the least-squares quadric in the vertex's tangent frame through the
/// vertices up to two edges away (Cazals and Pouget 2005, doi:10.1016/j.cagd.2004.09.004). Of the
/// vertices two edges away, only those count whose normals face the same way. Exact on quadrics
/// seen along their axis. If there are too few vertices, the flattest quadric is used. 0 at
/// vertices without triangles. At edges and corners, whose curvature is infinite, the result is
/// that of a rounding as wide as the neighbourhood. Equal vertices count as one. The result does
/// not depend on `threads` (0: one per hardware thread). Throws InvalidInput on damaged meshes,
/// Interrupted.
std::vector<float> mean_curvature(const TriangleMesh& mesh, int threads = 0,
                                  const Watch& watch = {});

}  // namespace surf
