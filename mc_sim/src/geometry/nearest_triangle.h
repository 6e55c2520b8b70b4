// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/triangle_shape.h"
#include "surf/mesh/triangle_tree.h"

namespace surf::mc {

/// A triangle that is near a point. Its distance is never too large by more than rounding (1e-6 nm
/// up to millimetres from the origin), needles included.
struct NearestTriangle {
  double distance = HUGE_VAL;  ///< or a limit, where `triangle` is none
  std::uint32_t triangle = TriangleTree::none;
  Vec3 point;  ///< on the triangle
};

/// Replaces `best` by a triangle if it is nearer to `p`: a good guess makes the search below short.
inline void improve(const TriangleTree& tree, const Vec3& p, std::uint32_t triangle,
                    NearestTriangle& best) {
  const Corners t = tree.corners(triangle);
  const Vec3 v[3] = {t.a - p, t.b - p, t.c - p};
  Vec3 point;
  const double distance = distance_of_triangle(v, TriangleShape(v), point);
  if (distance < best.distance) best = {distance, triangle, p + point};
}

/// Replaces `best` by the nearest triangle that is nearer than it.
inline void improve(const TriangleTree& tree, const Vec3& p, NearestTriangle& best) {
  tree.visit_near(
      p, [&] { return best.distance * best.distance; },
      [&](std::uint32_t triangle) { improve(tree, p, triangle, best); });
}

/// Appends the triangles whose boxes come within `radius` of `p`, in the tree's order.
inline void append_within(const TriangleTree& tree, const Vec3& p, double radius,
                          std::vector<std::uint32_t>& out) {
  const double squared = radius * radius * (1 + 1e-9);
  tree.visit_near(
      p, [&] { return squared; }, [&](std::uint32_t triangle) { out.push_back(triangle); });
}

}  // namespace surf::mc
