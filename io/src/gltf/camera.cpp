// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera.h"

#include <algorithm>
#include <cmath>

namespace surf::io {
namespace {

constexpr double yfov = 0.7;
constexpr double azimuth = 0.5;  // to the right of the front, which shows the specimen's -y side
constexpr double elevation = 0.65;
constexpr double filled = 0.92;  // share of the half picture that the box may take

std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> points;
  for (std::size_t i = 0; i < 8; ++i) {
    points[i] = {i & 1 ? box.upper_nm.x : box.lower_nm.x, i & 2 ? box.upper_nm.y : box.lower_nm.y,
                 i & 4 ? box.upper_nm.z : box.lower_nm.z};
  }
  return points;
}

}  // namespace

GltfCamera frame_box(const Box& framed, const Box& all, double smallest) {
  const Vec3 back{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                  std::cos(azimuth) * std::cos(elevation)};
  const Vec3 right{std::cos(azimuth), 0, -std::sin(azimuth)};
  const Vec3 up = cross(back, right);
  const Vec3 center = framed.center_nm();
  const double slope = filled * std::tan(yfov / 2);
  double distance = 0;
  for (const Vec3& corner : corners(framed)) {
    const Vec3 p = corner - center;
    const double aside = std::max(std::abs(dot(p, right)), std::abs(dot(p, up)));
    distance = std::max(distance, dot(p, back) + aside / slope);
  }
  if (!(distance > 0)) distance = smallest;
  double farthest = 0;
  for (const Vec3& corner : corners(all)) farthest = std::max(farthest, length(corner - center));
  // A turn about y by the azimuth after one about x by -elevation.
  const double sy = std::sin(azimuth / 2), cy = std::cos(azimuth / 2);
  const double sx = std::sin(-elevation / 2), cx = std::cos(elevation / 2);
  return {center + back * distance,
          {cy * sx, sy * cx, -sy * sx, cy * cx},
          yfov,
          distance / 100,
          std::max(4 * distance, 2 * (distance + farthest))};
}

}  // namespace surf::io
