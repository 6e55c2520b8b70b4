// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Triangulates a closed polygon with little area and gentle folds (CGAL's
/// triangulate_hole_polyline). Corners are numbered in their order. Empty if CGAL finds no
/// triangulation. Every side i -> i + 1 of the polygon is a side of one triangle, in the same
/// direction. Throws Interrupted.
std::vector<Triangle> span_polygon(const std::vector<Vec3>& corners, const Watch& watch);

}  // namespace surf
