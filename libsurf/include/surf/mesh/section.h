// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// The line segments in which a mesh intersects the plane y = `y_nm`, one for each triangle that
/// crosses the plane. Triangles that lie in the plane or touch it from above are skipped, so that
/// no edge appears twice.
std::vector<std::array<Vec3, 2>> section_at_y(const TriangleMesh& mesh, double y_nm);

}  // namespace surf
