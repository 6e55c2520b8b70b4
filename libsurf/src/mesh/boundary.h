// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/edges.h"

namespace surf {

/// A closed run of sides that no other triangle answers, in the direction of their triangles: a
/// sheet whose normals point to the viewer lies to the left of it.
struct BoundaryLoop {
  std::vector<std::uint32_t> points;  ///< no point twice
  std::vector<Side> sides;            ///< sides[i] runs from points[i] to the next one
};

/// The loops of a mesh's boundary, in the order of their first sides. Triangles hold points (see
/// Weld). At an edge with several triangles, sides that run against each other answer each other.
/// Boundaries that meet in a point are parted there. Sides that cannot be joined to a loop, because
/// triangles are turned against each other, are left out.
std::vector<BoundaryLoop> boundary_loops(const std::vector<Triangle>& triangles,
                                         std::size_t points);

}  // namespace surf
