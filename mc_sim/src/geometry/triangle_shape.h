// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "surf/core/triangle_geometry.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// A triangle's plane and size, from its corners.
struct TriangleShape {
  /// Width over length of triangles whose plane is not trusted.
  static constexpr double needle = 1e-6;

  Vec3 across;                 ///< normal, as long as twice the area
  double area2 = 0;            ///< twice the area
  double longest_squared = 0;  ///< of the sides

  explicit TriangleShape(const Vec3 (&v)[3]) : across(cross(v[1] - v[0], v[2] - v[0])) {
    area2 = length(across);
    const Vec3 e[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    longest_squared = std::max({dot(e[0], e[0]), dot(e[1], e[1]), dot(e[2], e[2])});
  }
  bool is_needle() const { return !(area2 > needle * longest_squared); }
};

/// At most the distance of 0 from the triangle, and the point that it is taken to.
inline double distance_of_triangle(const Vec3 (&v)[3], const TriangleShape& shape, Vec3& point) {
  if (!shape.is_needle()) {
    point = closest_point(v[0], v[1], v[2], {});
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
