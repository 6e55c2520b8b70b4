// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// The straight pieces in which a mesh meets the plane y = `y_nm`, one per triangle that crosses
/// it. Triangles that lie in the plane or touch it from above are left out, so that no edge comes
/// twice.
std::vector<std::array<Vec3, 2>> section_at_y(const TriangleMesh& mesh, double y_nm);

}  // namespace surf
