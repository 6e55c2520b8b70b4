// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// The merger of one vertex of the halfedge mesh into another.
struct Collapse {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

struct DecimateOptions {
  double tolerance_nm = 0;    ///< 0: none. Kept in all likelihood, not certainly
  std::size_t triangles = 0;  ///< number to stop at; 0: none
  std::vector<Vec3> fixed;    ///< sorted by x, y, z; vertices at these places are kept
  /// By vertex, if not empty: 1 if it is kept.
  std::span<const std::uint8_t> kept;
  /// Collapses of an earlier run on the same mesh, which are repeated first, except where vertices
  /// are kept now. Beyond them only the surroundings of what was not repeated are looked at.
  std::span<const Collapse> repeated;
  Watch watch;
};

struct Decimated {
  TriangleMesh mesh;  ///< over the vertices of the original, not merged
  std::vector<Collapse> collapses;
};

/// Merges vertices into neighbours in the order of their quadric error. `mesh` is merged
/// (merge_equal_vertices).
Decimated decimate(const TriangleMesh& mesh, const DecimateOptions& options);

/// The order of `DecimateOptions::fixed`.
bool is_before(const Vec3& a, const Vec3& b);

}  // namespace surf
