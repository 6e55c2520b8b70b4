// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "surf/core/vec3.h"

namespace surf {

/// A convex polygon that is a piece of a triangle. Rounding moves corners that cuts made: by at
/// most `cuts` times the rounding of one.
struct CutPolygon {
  static constexpr std::size_t most_corners = 12;

  std::array<Vec3, most_corners> corner;
  std::uint8_t size = 0;
  std::uint8_t cuts = 0;
  std::uint32_t near = 0;  ///< a triangle of the other surface that may be near

  void add(const Vec3& p) { corner[size++] = p; }
  Vec3 middle() const {
    Vec3 sum;
    for (std::size_t i = 0; i < size; ++i) sum += corner[i];
    return sum * (1.0 / size);
  }
  /// Two corners far from each other.
  std::pair<Vec3, Vec3> ends() const {
    const Vec3 first = farthest(corner[0]);
    return {first, farthest(first)};
  }

 private:
  Vec3 farthest(const Vec3& from) const {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < size; ++i) {
      const Vec3 d = corner[i] - from;
      if (dot(d, d) > most) most = dot(d, d), best = i;
    }
    return corner[best];
  }
};

/// Cuts a polygon by the plane through `at` with the normal `up` (of length 1). Returns false,
/// changing nothing, if a part would be no thicker than `least` or the polygon is not convex enough
/// to fall into two. The two parts cover the polygon: they share the corners of the cut.
inline bool cut(const CutPolygon& p, const Vec3& at, const Vec3& up, double least,
                CutPolygon& above, CutPolygon& below) {
  std::array<double, CutPolygon::most_corners> height;
  double low = 0, high = 0;
  for (std::size_t i = 0; i < p.size; ++i) {
    height[i] = dot(up, p.corner[i] - at);
    low = std::min(low, height[i]);
    high = std::max(high, height[i]);
  }
  if (!(low < -least && high > least) || p.size >= CutPolygon::most_corners) return false;
  int turns = 0;
  bool was_above = false, known = false, first_above = false;
  for (std::size_t i = 0; i < p.size; ++i) {
    if (!(height[i] > least || height[i] < -least)) continue;
    const bool is_above = height[i] > 0;
    if (!known) first_above = is_above;
    else turns += is_above != was_above;
    was_above = is_above;
    known = true;
  }
  turns += was_above != first_above;
  if (turns != 2) return false;
  above.size = below.size = 0;
  above.cuts = below.cuts = static_cast<std::uint8_t>(p.cuts + 1);
  above.near = below.near = p.near;
  for (std::size_t i = 0; i < p.size; ++i) {
    const std::size_t j = i + 1 == p.size ? 0 : i + 1;
    if (height[i] >= -least) above.add(p.corner[i]);
    if (height[i] <= least) below.add(p.corner[i]);
    if ((height[i] > least && height[j] < -least) || (height[i] < -least && height[j] > least)) {
      const double share = height[i] / (height[i] - height[j]);
      const Vec3 crossing = p.corner[i] + (p.corner[j] - p.corner[i]) * share;
      above.add(crossing);
      below.add(crossing);
    }
  }
  return true;
}

/// Divides a polygon of four or more corners along the line between two of them.
inline void cut_at_corners(const CutPolygon& p, CutPolygon& one, CutPolygon& other) {
  const std::size_t half = p.size / 2;
  one.size = other.size = 0;
  one.cuts = other.cuts = static_cast<std::uint8_t>(p.cuts + 1);
  one.near = other.near = p.near;
  for (std::size_t i = 0; i <= half; ++i) one.add(p.corner[i]);
  for (std::size_t i = half; i < p.size; ++i) other.add(p.corner[i]);
  other.add(p.corner[0]);
}

}  // namespace surf
