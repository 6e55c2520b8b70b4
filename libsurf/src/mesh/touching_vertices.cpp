// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/touching_vertices.h"

#include "core/argument.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {

std::vector<std::uint8_t> touching_vertices(const TriangleMesh& mesh, const TriangleMesh& other,
                                            double distance_nm) {
  require_not_negative(distance_nm, "distance");
  validate(mesh);
  validate(other);
  std::vector<std::uint8_t> touching(mesh.vertices_nm.size(), 0);
  Box near = bounds(other);
  near.lower_nm -= {distance_nm, distance_nm, distance_nm};
  near.upper_nm += {distance_nm, distance_nm, distance_nm};
  if (!overlap(near, bounds(mesh))) return touching;
  const TriangleTree tree(other);
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const Vec3& p = mesh.vertices_nm[i];
    Box point;
    point.extend(p);
    if (!overlap(near, point)) continue;
    point.lower_nm -= {distance_nm, distance_nm, distance_nm};
    point.upper_nm += {distance_nm, distance_nm, distance_nm};
    tree.visit_overlapping(point, [&](std::uint32_t triangle) {
      if (length(closest_point(tree.corners(triangle), p) - p) <= distance_nm) touching[i] = 1;
    });
  }
  return touching;
}

}  // namespace surf
