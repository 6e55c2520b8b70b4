// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/vec3.h"

namespace surf {

// Closed polygons seen from above.

inline double cross_xy(const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; }

/// The centroid of the polygon's area, and the signed area: > 0 if the polygon runs
/// counter-clockwise.
struct RimCentroid {
  double x, y, area;
};

RimCentroid rim_centroid(const std::vector<Vec3>& rim);

/// The angles between neighbouring vertices, seen from the centroid. Empty if the polygon, which
/// must run counter-clockwise, turns back anywhere or runs round more than once, because it is not
/// star-shaped then.
std::vector<double> star_angles(const std::vector<Vec3>& rim, const RimCentroid& c);

}  // namespace surf
