// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct PlanarEdge {
  std::uint32_t from, to;
};

/// Triangulates the region between closed lines in a plane, counter-clockwise, by a constrained
/// Delaunay triangulation. The region lies to the left of each edge; outlines may have holes and
/// touch at points. Empty if edges cross or points coincide. With `graded`, points are added inside
/// the region and appended to `points`, so that triangles grow with the distance from outlines that
/// have many points; without it, triangles are as long as the region is wide (refinement after
/// Chew, doi:10.1145/160985.161150, that leaves the outlines unchanged).
std::vector<Triangle> triangulate_region(std::vector<std::array<double, 2>>& points,
                                         const std::vector<PlanarEdge>& edges, bool graded);

}  // namespace surf
