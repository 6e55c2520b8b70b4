// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct SelfIntersectionOptions {
  /// Number of pairs after which the search stops, >= 1. With 1 the result only says whether there
  /// are any.
  std::size_t limit = 100000;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Places where a surface passes through itself or lies on itself.
struct SelfIntersections {
  /// Pairs of triangles that have more in common than shared corners: the lower number first, in
  /// rising order, at most as many as the limit.
  std::vector<std::array<std::uint32_t, 2>> pairs;
  bool complete = true;  ///< false: the limit was reached and there may be more
  Vec3 first_nm;         ///< a place near the first pair's intersection, if there is any
};

/// Finds all self-intersections with exact predicates. Triangles that share an edge count if they
/// lie on each other, triangles that share a corner if they meet elsewhere. Corners with exactly
/// equal coordinates are the same corner; triangles without area are ignored (see
/// MeshReport::degenerate_triangles). Takes seconds for a million triangles. Throws InvalidInput on
/// damaged meshes, UsageError if the limit is 0, Interrupted.
SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          const SelfIntersectionOptions& options = {});

}  // namespace surf
