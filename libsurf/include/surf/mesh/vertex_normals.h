// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A unit normal for each vertex: the sum of the normals of its triangles, each weighted by its
/// angle at that vertex, so that the result depends on the surface and not on its triangulation
/// (Thürmer and Wüthrich, Journal of Graphics Tools 3(1), 1998,
/// doi:10.1080/10867651.1998.10487487). Triangles without area do not count. If no triangle counts,
/// or the sum cancels, the normal is (0, 0, 1). `mesh` must be valid.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

}  // namespace surf
