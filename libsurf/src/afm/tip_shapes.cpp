// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

constexpr double right_angle = std::numbers::pi / 2;
constexpr double none = std::numeric_limits<double>::infinity();

void demand(bool holds, const char* what, double value, const char* remedy) {
  if (!holds)
    throw InvalidInput("tip", fmt::format("{} of {:g} is not possible", what, value), remedy);
}

void check(const TipSampling& s) {
  for (const double pitch : {s.pitch_x_nm, s.pitch_y_nm})
    demand(pitch > 0 && std::isfinite(pitch), "a pitch", pitch, "Give one above 0 nm");
  for (const int size : {s.width, s.height})
    demand(size >= 1, "a size", size, "Give 1 or more samples");
}

/// Samples height(x, y) of the physical tip.
template <class Height>
Tip sample(const TipSampling& s, const Height& height) {
  Tip tip{{s.pitch_x_nm, s.pitch_y_nm}, Grid<double>(s.width, s.height), s.width / 2, s.height / 2};
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const double z = height(-(x - tip.apex_x) * s.pitch_x_nm, -(y - tip.apex_y) * s.pitch_y_nm);
      tip.z_nm(x, y) = z > 0 ? -z : 0.0;  // rounding may make z negative at the apex
    }
  return tip;
}

double sphere(double radius, double r) {
  // radius - sqrt(radius^2 - r^2) without cancellation.
  return r * r / (radius + std::sqrt(std::max(0.0, radius * radius - r * r)));
}

struct Slope {
  double x = 0, y = 0;
  double operator()(double px, double py) const { return x * px + y * py; }
};

/// A ray from the apex along which two faces meet.
struct Edge {
  double x = 0, y = 0;  ///< unit vector
  double slope = 0;
};

double largest(const std::vector<Slope>& faces, double x, double y) {
  double z = 0;
  for (const Slope& f : faces) z = std::max(z, f(x, y));
  return z;
}

std::vector<Edge> edges_of(const std::vector<Slope>& faces) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t j = i + 1; j < faces.size(); ++j)
      for (const double side : {1.0, -1.0}) {
        const double dx = -(faces[i].y - faces[j].y) * side, dy = (faces[i].x - faces[j].x) * side;
        const double length = std::hypot(dx, dy);
        if (length == 0) continue;
        const Edge e{dx / length, dy / length, faces[i](dx, dy) / length};
        if (e.slope >= largest(faces, e.x, e.y) * (1 - 1e-12)) edges.push_back(e);
      }
  return edges;
}

/// The height over (x, y) of the pyramid z = max of the faces, offset by `radius` to all sides: min
/// over q of z(q) - sqrt(radius^2 - |(x, y) - q|^2). The minimum lies above a face, an edge or the
/// apex.
double rounded(const std::vector<Slope>& faces, const std::vector<Edge>& edges, double radius,
               double x, double y) {
  double z = none;
  for (const Slope& f : faces) {
    const double n = std::sqrt(1 + f.x * f.x + f.y * f.y);
    const double qx = x - radius * f.x / n, qy = y - radius * f.y / n;
    if (f(qx, qy) >= largest(faces, qx, qy) * (1 - 1e-12)) z = std::min(z, f(x, y) - radius * n);
  }
  for (const Edge& e : edges) {
    const double along = e.x * x + e.y * y, across = e.x * y - e.y * x;
    if (std::abs(across) > radius) continue;
    const double rest = std::sqrt(radius * radius - across * across),
                 n = std::sqrt(1 + e.slope * e.slope);
    if (along - rest * e.slope / n >= 0) z = std::min(z, e.slope * along - rest * n);
  }
  const double r = std::hypot(x, y);
  if (r <= radius) z = std::min(z, sphere(radius, r) - radius);
  return z + radius;
}

}  // namespace

Tip parabolic_tip(double radius_nm, const TipSampling& s) {
  check(s);
  demand(radius_nm > 0 && std::isfinite(radius_nm), "a radius", radius_nm, "Give one above 0 nm");
  return sample(s, [&](double x, double y) { return (x * x + y * y) / (2 * radius_nm); });
}

Tip conical_tip(double radius_nm, double half_angle_rad, const TipSampling& s) {
  check(s);
  demand(radius_nm >= 0 && std::isfinite(radius_nm), "a radius", radius_nm, "Give 0 nm or more");
  demand(half_angle_rad > 0 && half_angle_rad < right_angle, "a half angle in degrees",
         half_angle_rad / degrees_to_radians, "Give one between 0 and 90 degrees");
  const double sine = std::sin(half_angle_rad), cosine = std::cos(half_angle_rad);
  return sample(s, [&](double x, double y) {
    const double r = std::hypot(x, y);
    if (r <= radius_nm * cosine) return radius_nm > 0 ? sphere(radius_nm, r) : 0.0;
    return r * cosine / sine - radius_nm * (1 / sine - 1);
  });
}

Tip ball_tip(double radius_nm, double stem_radius_nm, double stem_half_angle_rad,
             const TipSampling& s) {
  check(s);
  demand(radius_nm > 0 && std::isfinite(radius_nm), "a radius", radius_nm, "Give one above 0 nm");
  demand(stem_radius_nm > 0 && stem_radius_nm < radius_nm, "a stem radius", stem_radius_nm,
         "Give one above 0 and below the ball's");
  demand(stem_half_angle_rad >= 0 && stem_half_angle_rad < right_angle,
         "a stem half angle in degrees", stem_half_angle_rad / degrees_to_radians,
         "Give one from 0 to below 90 degrees");
  const double neck =
      radius_nm + std::sqrt(radius_nm * radius_nm - stem_radius_nm * stem_radius_nm);
  return sample(s, [&](double x, double y) {
    const double r = std::hypot(x, y);
    if (r <= radius_nm) return sphere(radius_nm, r);
    return stem_half_angle_rad > 0 ? neck + (r - stem_radius_nm) / std::tan(stem_half_angle_rad)
                                   : none;
  });
}

Tip pyramidal_tip(const PyramidShape& shape, const TipSampling& s) {
  check(s);
  demand(shape.face_angles_rad.size() >= 3, "a number of faces",
         static_cast<double>(shape.face_angles_rad.size()), "Give 3 angles or more");
  demand(shape.radius_nm >= 0 && std::isfinite(shape.radius_nm), "a radius", shape.radius_nm,
         "Give 0 nm or more");
  demand(std::isfinite(shape.rotation_rad), "a rotation", shape.rotation_rad, "Give an angle");
  std::vector<Slope> faces;
  for (std::size_t i = 0; i < shape.face_angles_rad.size(); ++i) {
    const double angle = shape.face_angles_rad[i];
    demand(angle > 0 && angle < right_angle, "a face angle in degrees", angle / degrees_to_radians,
           "Give one between 0 and 90 degrees");
    const double azimuth =
        shape.rotation_rad + 2 * std::numbers::pi * static_cast<double>(i) /
                                 static_cast<double>(shape.face_angles_rad.size());
    faces.push_back({std::cos(azimuth) / std::tan(angle), std::sin(azimuth) / std::tan(angle)});
  }
  const std::vector<Edge> edges = edges_of(faces);
  return sample(s, [&](double x, double y) {
    return shape.radius_nm > 0 ? rounded(faces, edges, shape.radius_nm, x, y)
                               : largest(faces, x, y);
  });
}

Tip hemisphere_tip(double radius_nm, double pitch_x_nm, double pitch_y_nm, int max_width,
                   int max_height) {
  demand(radius_nm >= 0 && std::isfinite(radius_nm), "a radius", radius_nm, "Give 0 nm or more");
  const auto reach = [&](double pitch, int most) {
    return static_cast<int>(std::min(std::floor(radius_nm / pitch), most - 1.0));
  };
  const TipSampling s{pitch_x_nm, pitch_y_nm, 2 * reach(pitch_x_nm, max_width) + 1,
                      2 * reach(pitch_y_nm, max_height) + 1};
  check(s);
  return sample(s, [&](double x, double y) {
    const double r = std::hypot(x, y);
    return r == 0 ? 0.0 : r <= radius_nm ? sphere(radius_nm, r) : none;
  });
}

}  // namespace surf
