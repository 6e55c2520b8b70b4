// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/edges.h"

namespace surf {

/// A closed loop of unpaired sides, in the direction of their triangles. Seen from the side that
/// the normals point to, the sheet lies to the left of the loop.
struct BoundaryLoop {
  std::vector<std::uint32_t> points;  ///< without repetition
  std::vector<Side> sides;            ///< sides[i] runs from points[i] to the next one
};

/// The boundary loops of a mesh, in the order of their first sides. Triangles hold points (see
/// Weld). At an edge with several triangles, sides of opposite direction pair up. Boundaries that
/// meet in a point are separated there. Sides that cannot be joined to a loop, because triangles
/// are oriented against each other, are left out.
std::vector<BoundaryLoop> boundary_loops(const std::vector<Triangle>& triangles,
                                         std::size_t points);

}  // namespace surf
