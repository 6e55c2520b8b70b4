// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "surf/core/vec3.h"

namespace surf::mc {

/// A triangle's plane and size, from its corners.
struct TriangleShape {
  /// Width over length of triangles whose plane is not trusted.
  static constexpr double needle = 1e-6;

  Vec3 across;              ///< normal, as long as twice the area
  double area2 = 0;         ///< twice the area
  double longest_squared = 0;   ///< of the sides

  explicit TriangleShape(const Vec3 (&v)[3]) : across(cross(v[1] - v[0], v[2] - v[0])) {
    area2 = length(across);
    const Vec3 e[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    longest_squared = std::max({dot(e[0], e[0]), dot(e[1], e[1]), dot(e[2], e[2])});
  }
  bool is_needle() const { return !(area2 > needle * longest_squared); }
};

/// The point of a triangle nearest to 0 (Ericson, Real-Time Collision Detection, 5.1.5).
inline Vec3 nearest_of_triangle(const Vec3 (&v)[3]) {
  const Vec3 ab = v[1] - v[0], ac = v[2] - v[0];
  const double d1 = -dot(ab, v[0]), d2 = -dot(ac, v[0]);
  if (d1 <= 0 && d2 <= 0) return v[0];
  const double d3 = -dot(ab, v[1]), d4 = -dot(ac, v[1]);
  if (d3 >= 0 && d4 <= d3) return v[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return v[0] + ab * (d1 / (d1 - d3));
  const double d5 = -dot(ab, v[2]), d6 = -dot(ac, v[2]);
  if (d6 >= 0 && d5 <= d6) return v[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return v[0] + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return v[1] + (v[2] - v[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1 / (va + vb + vc);
  return v[0] + ab * (vb * scale) + ac * (vc * scale);
}

/// At most the distance of 0 from the triangle, and the point that it is taken to.
inline double distance_of_triangle(const Vec3 (&v)[3], const TriangleShape& shape, Vec3& point) {
  if (!shape.is_needle()) {
    point = nearest_of_triangle(v);
    return length(point);
  }
  // As good as its longest side; what lies beside that is allowed for.
  int longest = 0;
  double most = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = v[(i + 1) % 3] - v[i];
    if (dot(e, e) > most) {
      most = dot(e, e);
      longest = i;
    }
  }
  const Vec3 a = v[longest], ab = v[(longest + 1) % 3] - a;
  const double t = most > 0 ? std::clamp(-dot(a, ab) / most, 0.0, 1.0) : 0.0;
  point = a + ab * t;
  return std::max(0.0, length(point) - TriangleShape::needle * std::sqrt(most));
}

}  // namespace surf::mc
