// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/rim.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace surf {

RimCentroid rim_centroid(const std::vector<Vec3>& rim) {
  // Relative to a vertex, because rounding would spoil the area far from (0, 0).
  const Vec3 origin = rim.front();
  RimCentroid c{0, 0, 0};
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 a = rim[i] - origin;
    const Vec3 b = rim[(i + 1) % rim.size()] - origin;
    const double twice = cross_xy(a, b);
    c.area += 0.5 * twice;
    c.x += twice * (a.x + b.x) / 6;
    c.y += twice * (a.y + b.y) / 6;
  }
  if (c.area == 0) return c;
  return {origin.x + c.x / c.area, origin.y + c.y / c.area, c.area};
}

std::vector<double> star_angles(const std::vector<Vec3>& rim, const RimCentroid& c) {
  std::vector<double> result;
  double turn = 0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 a = rim[i] - Vec3{c.x, c.y, 0};
    const Vec3 b = rim[(i + 1) % rim.size()] - Vec3{c.x, c.y, 0};
    const double angle = std::atan2(cross_xy(a, b), a.x * b.x + a.y * b.y);
    if (!(angle > 0 && angle < std::numbers::pi)) return {};
    result.push_back(angle);
    turn += angle;
  }
  if (turn > 3 * std::numbers::pi) return {};
  return result;
}

}  // namespace surf
