// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// Attempts by CGAL; the caller judges the result. Empty where CGAL gives up. Both throw
// Interrupted.

/// The union of closed bodies with outward normals, each free of self-intersections.
TriangleMesh unite(const std::vector<TriangleMesh>& bodies, const Watch& watch);

/// The surroundings of self-intersections, cut out and filled anew.
TriangleMesh mend_self_intersections(const TriangleMesh& mesh, const Watch& watch);

}  // namespace surf
