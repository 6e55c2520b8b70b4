// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// Repairs by CGAL, whose results the caller must check. The result is empty if CGAL gives up. Both
// functions throw Interrupted.

/// The union of closed bodies with outward normals, each free of self-intersections.
TriangleMesh unite(const std::vector<TriangleMesh>& bodies, const Watch& watch);

/// Cuts out the surroundings of self-intersections and fills them again.
TriangleMesh mend_self_intersections(const TriangleMesh& mesh, const Watch& watch);

}  // namespace surf
