// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Triangles over the corners of a closed polygon, numbered as they come, that span it with little
/// area and gentle folds (CGAL's triangulate_hole_polyline); empty where none is found. Every side
/// i -> i + 1 of the polygon is a side of one of them, the same way round. Throws
/// Interrupted.
std::vector<Triangle> span_polygon(const std::vector<Vec3>& corners, const Watch& watch);

}  // namespace surf
