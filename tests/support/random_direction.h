// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/core/random.h"
#include "surf/core/vec3.h"

namespace surf::test {

/// A unit vector, all directions alike.
inline Vec3 isotropic(RandomStream& random) {
  const double c = 1 - 2 * random.uniform(), f = 6.283185307 * random.uniform();
  const double s = std::sqrt(1 - c * c);
  return {s * std::cos(f), s * std::sin(f), c};
}

}  // namespace surf::test
