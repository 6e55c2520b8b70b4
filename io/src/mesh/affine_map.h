// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "surf/core/vec3.h"

namespace surf::io {

/// x -> columns[0] x.x + columns[1] x.y + columns[2] x.z + columns[3].
struct AffineMap {
  std::array<Vec3, 4> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{}};

  Vec3 operator()(const Vec3& p) const {
    return columns[0] * p.x + columns[1] * p.y + columns[2] * p.z + columns[3];
  }
  /// Whether the map turns right-handed shapes into left-handed ones.
  bool mirrors() const { return dot(columns[0], cross(columns[1], columns[2])) < 0; }
};

/// The map that applies `inner` first, then `outer`.
inline AffineMap product(const AffineMap& outer, const AffineMap& inner) {
  AffineMap result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& c = inner.columns[i];
    result.columns[i] = outer.columns[0] * c.x + outer.columns[1] * c.y + outer.columns[2] * c.z;
  }
  result.columns[3] = outer(inner.columns[3]);
  return result;
}

}  // namespace surf::io
