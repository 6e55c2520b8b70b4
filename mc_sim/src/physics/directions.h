// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/sin_cos.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// The direction at the polar angle with this cosine from z, at the azimuth `turn`.
inline Vec3 from_axis(double cos_theta, double turn) {
  double sine, cosine;
  sin_cos_turn(turn, sine, cosine);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  return {sin_theta * cosine, sin_theta * sine, cos_theta};
}

/// A direction that is given in the frame of another, `d` as its z axis. Basis: Duff et al., JCGT
/// 6(1), 2017.
inline Vec3 from_frame_of(const Vec3& d, const Vec3& local) {
  const double sign = std::copysign(1.0, d.z);
  const double a = -1.0 / (sign + d.z);
  const double b = d.x * d.y * a;
  Vec3 out{local.x * (1.0 + sign * d.x * d.x * a) + local.y * b + local.z * d.x,
           local.x * sign * b + local.y * (sign + d.y * d.y * a) + local.z * d.y,
           -local.x * sign * d.x - local.y * d.y + local.z * d.z};
  return out * (1.5 - 0.5 * dot(out, out));  // one Newton step keeps the length at 1
}

/// `direction` turned by the polar angle with this cosine, at the azimuth `turn` about itself.
inline Vec3 deflected(const Vec3& d, double cos_theta, double turn) {
  return from_frame_of(d, from_axis(cos_theta, turn));
}

}  // namespace surf::mc
