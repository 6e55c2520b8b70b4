// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct DistanceBoundOptions {
  /// The bound is at most this share larger than the distance; > 0. Where that would take more than
  /// 120 cuts across one place, or tens of thousands of pieces of one triangle, it is larger, and
  /// still a bound.
  double accuracy = 0.01;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Proven upper bounds of the distance between two surfaces (Hausdorff): no point of either
/// surface, at corners or between them, is farther from the other surface. Rounding is allowed for.
struct DistanceBound {
  double from_first_nm = 0;   ///< of the distance of the first surface's points from the second
  double from_second_nm = 0;  ///< of the distance of the second surface's points from the first

  double largest_nm() const { return std::max(from_first_nm, from_second_nm); }
  /// False if coordinates are so large that their squares overflow; then a bound is infinite.
  bool proven() const { return std::isfinite(from_first_nm) && std::isfinite(from_second_nm); }
};

/// Bounds the distance between two surfaces. The distance from one triangle is a convex function of
/// the point, so over a polygon it is largest at a corner: each triangle is cut into polygons until
/// all corners of each are near enough to one triangle of the other surface. Bounds below 1e-10 of
/// the diagonal of both are not made smaller. `mesh_deviation` (mesh_deviation.h) measures the same
/// at samples, from below.
///
/// Deterministic. Throws UsageError if `accuracy` is not above 0, InvalidInput on damaged meshes,
/// Interrupted.
DistanceBound bound_distance(const TriangleMesh& first, const TriangleMesh& second,
                             const DistanceBoundOptions& options = {});

}  // namespace surf
