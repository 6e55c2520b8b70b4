// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/sin_cos.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// The direction at the polar angle with this cosine from z, at the azimuth `turn`.
inline Vec3 from_axis(double cos_theta, double turn) {
  double sine, cosine;
  sin_cos_turn(turn, sine, cosine);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  return {sin_theta * cosine, sin_theta * sine, cos_theta};
}

/// `direction` turned by the polar angle with this cosine, at the azimuth `turn` about itself.
/// Basis: Duff et al., JCGT 6(1), 2017.
inline Vec3 deflected(const Vec3& d, double cos_theta, double turn) {
  double sine, cosine;
  sin_cos_turn(turn, sine, cosine);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  const double sx = sin_theta * cosine;
  const double sy = sin_theta * sine;
  const double sign = std::copysign(1.0, d.z);
  const double a = -1.0 / (sign + d.z);
  const double b = d.x * d.y * a;
  Vec3 out{sx * (1.0 + sign * d.x * d.x * a) + sy * b + cos_theta * d.x,
           sx * sign * b + sy * (sign + d.y * d.y * a) + cos_theta * d.y,
           -sx * sign * d.x - sy * d.y + cos_theta * d.z};
  return out * (1.5 - 0.5 * dot(out, out));   // one Newton step keeps the length at 1
}

}  // namespace surf::mc
