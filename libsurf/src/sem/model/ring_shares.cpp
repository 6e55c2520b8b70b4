// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/model/ring_shares.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surf {

std::vector<RingPoint> ring_points(int k, double ring_nm, double pixel_nm) {
  // Points are at most a sixteenth of a pixel apart, and at least 3 x 8 in an octant.
  const double outer = (k + 1) * ring_nm, spacing = pixel_nm / 16;
  const int radii = std::clamp(static_cast<int>(std::ceil(ring_nm / spacing)), 3, 64);
  const int angles =
      std::clamp(static_cast<int>(std::ceil(outer * std::numbers::pi / 4 / spacing)), 8, 4096);
  std::vector<RingPoint> points;
  for (int i = 0; i < radii; ++i) {
    const double t = (i + 0.5) / radii;  // share of the ring's area
    const double r = ring_nm * std::sqrt((1 - t) * k * k + t * (k + 1.0) * (k + 1.0));
    for (int j = 0; j < angles; ++j) {
      const double angle = (j + 0.5) / angles * std::numbers::pi / 4, c = std::cos(angle),
                   s = std::sin(angle);
      const int u = static_cast<int>(std::floor(r * c / pixel_nm + 0.5));
      const int v = static_cast<int>(std::floor(r * s / pixel_nm + 0.5));
      for (const int sx : {1, -1})
        for (const int sy : {1, -1}) {
          points.push_back({sx * u, sy * v, sx * c, sy * s});
          points.push_back({sx * v, sy * u, sx * s, sy * c});
        }
    }
  }
  return points;
}

int ring_reach(int rings, double ring_nm, double pixel_nm) {
  return static_cast<int>(std::floor(rings * ring_nm / pixel_nm + 0.5));
}

}  // namespace surf
