// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/edges.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Walks over a surface from one of its vertices to another, straight as seen along a direction.
class OriginalSection {
 public:
  /// `mesh` is merged (merge_equal_vertices) and must outlive this.
  OriginalSection(const TriangleMesh& mesh, const Watch& watch);

  /// Whether the section of the surface along the line from vertex `from` to vertex `to`, seen
  /// against `up`, stays within the root of `squared_nm` of that line, wherever it crosses an edge.
  /// False also where the walk ends at a rim or goes astray.
  bool stays_near(std::uint32_t from, std::uint32_t to, const Vec3& up, double squared_nm) const;

 private:
  static constexpr Side none = 0xffffffffu;
  /// The side of `from`'s triangles, opposite of it, through which the walk leaves them.
  Side first_side(std::uint32_t from, std::uint32_t to, const Vec3& up, const Vec3& left) const;

  const TriangleMesh& mesh_;
  std::vector<Side> twin_;  ///< the side along the same edge of the only other triangle
  std::vector<std::size_t> begin_;
  std::vector<Side> corners_;  ///< of every vertex
};

}  // namespace surf
