// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/core/vec3.h"

namespace surf {

/// The point of the segment from `a` to `b` that is nearest to `p`.
inline Vec3 closest_point_of_line(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 ab = b - a;
  const double along = dot(p - a, ab), whole = dot(ab, ab);
  if (!(along > 0 && whole > 0)) return a;
  return along < whole ? a + ab * (along / whole) : b;
}

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
/// A degenerate triangle is treated as a segment or a point. Corners must be finite.
inline Vec3 closest_point(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  const double run = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && run > 0) return b + (c - b) * ((d4 - d3) / run);
  const double area_squared = va + vb + vc;  // of the parallelogram
  if (!(area_squared >
        1e-14 * dot(ab, ab) * dot(ac, ac))) {  // degenerate: the nearest point of the sides
    const Vec3 sides[] = {closest_point_of_line(a, b, p), closest_point_of_line(b, c, p),
                          closest_point_of_line(c, a, p)};
    const Vec3* best = sides;
    for (const Vec3& side : sides)
      if (length(side - p) < length(*best - p)) best = &side;
    return *best;
  }
  const double scale = 1 / area_squared;
  return a + ab * (vb * scale) + ac * (vc * scale);
}

/// Half the solid angle that a triangle subtends at the origin, -pi to pi. Positive if the origin
/// sees the triangle from behind, as inside a closed mesh with outward normals. The sum over a
/// closed mesh is 2 pi times the winding number of the mesh around the origin (van Oosterom and
/// Strackee 1983, doi:10.1109/TBME.1983.325207). The result is 0 if the origin lies in the plane of
/// the triangle; if it lies on the triangle itself, the result is that of either side.
inline double half_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return std::atan2(dot(a, cross(b, c)),
                    la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace surf
