// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Maps vertices to points: vertices at the same place are one point.
struct Weld {
  static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

  /// The point of each vertex, or `unused` if no triangle uses the vertex. Points are numbered in
  /// the order of the vertices.
  std::vector<std::uint32_t> point;
  std::vector<std::uint32_t> first_vertex;  ///< first vertex of each point

  std::size_t points() const { return first_vertex.size(); }
  Triangle operator()(const Triangle& t) const { return {point[t[0]], point[t[1]], point[t[2]]}; }
};

/// Merges vertices with exactly equal coordinates (0 and -0 are equal) into points.
Weld weld_equal_vertices(const TriangleMesh& mesh);

}  // namespace surf
