// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "surf/core/units.h"
#include "surf/profile/fit_profile.h"

namespace surf {

ProfileData profile_data(const PlacedImage& image, const std::vector<ImageEdge>& edges) {
  ProfileData out;
  out.edges = edges;
  out.rows = image.values.height();
  out.row_distance_nm = image.pitch_y_nm;
  for (int e = 0; e < static_cast<int>(edges.size()); ++e)
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < image.values.width(); ++x) {
        const double at = image.x_nm(x);
        const ImageEdge& edge = edges[static_cast<std::size_t>(e)];
        if (at > edge.from_nm && at <= edge.to_nm && image.is_valid(x, y))
          out.samples.push_back({e, y, at, image.values(x, y)});
      }
  return out;
}

ProfileData profile_data(const PlacedImage& image, const Circle& hole, double to_nm) {
  ProfileData out;
  const double around_nm = 2 * std::numbers::pi * hole.radius_nm;
  out.rows = std::max(16, static_cast<int>(std::lround(around_nm / image.pitch_x_nm)));
  out.row_distance_nm = around_nm / out.rows;
  const Grid<double>& v = image.values;
  const double room = std::min(to_nm, room_about(image, hole));
  out.edges = {{0, true, hole.radius_nm, 0, room}};
  out.closed = true;
  for (int y = 0; y < v.height(); ++y)
    for (int x = 0; x < v.width(); ++x) {
      const double dx = image.x_nm(x) - hole.x_nm, dy = image.y_nm(y) - hole.y_nm,
                   r = std::hypot(dx, dy);
      if (!(r > 0 && r <= room) || !image.is_valid(x, y)) continue;
      double turn = std::atan2(dy, dx) / (2 * std::numbers::pi);
      if (turn < 0) turn += 1;
      out.samples.push_back(
          {0, std::min(out.rows - 1, static_cast<int>(turn * out.rows)), r, v(x, y)});
    }
  return out;
}

ProfileData profile_data(const PlacedImage& image, const HoleCut& cut) {
  constexpr double band = 0.4;  // of the radius: the rim turns by 24 degrees
  const double a = cut.azimuth_deg * degrees_to_radians, cosine = std::cos(a), sine = std::sin(a),
               radius = cut.hole.radius_nm, pixel = image.pitch_x_nm, half = band * radius;
  ProfileData out;
  out.rows = std::max(1, static_cast<int>(std::lround(2 * half / pixel)));
  out.row_distance_nm = 2 * half / out.rows;
  const double wall = cut.shortening * radius, room = room_about(image, cut.hole);
  out.edges = {{0, false, -wall, -room, 0}, {0, true, wall, 0, room}};
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x) {
      const double dx = image.x_nm(x) - cut.hole.x_nm, dy = image.y_nm(y) - cut.hole.y_nm,
                   along = cosine * dx + sine * dy, beside = cosine * dy - sine * dx;
      if (!(std::abs(beside) < half) || !image.is_valid(x, y)) continue;
      const double bent = cut.shortening * (radius - std::sqrt(radius * radius - beside * beside));
      const double at = along + (along < 0 ? -bent : bent);
      if (std::abs(at) > room) continue;
      const int row = static_cast<int>((beside + half) / out.row_distance_nm);
      out.samples.push_back(
          {along < 0 ? 0 : 1, std::min(row, out.rows - 1), at, image.values(x, y)});
    }
  return out;
}

}  // namespace surf
