// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {

/// An upper bound of the distance of `p` from a triangle, in nm. It allows for all rounding: the
/// distance from some point of the triangle is no larger than this, whatever its shape.
double distance_at_most(const Corners& triangle, const Vec3& p);

/// How closely a surface is looked at.
struct BoundAim {
  /// Pieces whose bound is not above this are not divided further; > 0.
  double enough_nm = 0;
  /// Where a point is farther off, its distance and this share of it are enough for what follows:
  /// so the bound is at most this share larger than the distance.
  double accuracy = 0.01;
  /// A triangle with a point that cannot be shown to be within this is given up.
  double limit_nm = std::numeric_limits<double>::infinity();
};

/// A triangle that could not be shown to be within the limit.
struct Unproven {
  std::uint32_t triangle = 0;
  std::uint32_t nearest = 0;  ///< of the other surface's triangles, at the point that failed
  double distance_nm = 0;     ///< that could be shown for that point
};

struct OneSidedBound {
  /// Of every point of the triangles that are not unproven.
  double bound_nm = 0;
  std::vector<Unproven> unproven;  ///< in the order of triangles
};

/// The smallest distance worth telling from 0: 1e-10 of the diagonal of both meshes.
double negligible_distance_nm(const TriangleMesh& first, const TriangleMesh& second);

/// Bounds the distance of every point of the triangles of `from` from the surface in the tree. The
/// distance from one fixed triangle is a convex function of the point, so over a polygon it is
/// largest at a corner. Each triangle is cut into polygons until every one is near enough to a
/// single triangle of the other surface. The result does not depend on the number of threads.
/// Throws Interrupted.
OneSidedBound bound_one_side(const TriangleMesh& from, const TriangleTree& to, const BoundAim& aim,
                             int threads, const Watch& watch);

}  // namespace surf
