// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/gun.h"

#include <cmath>

#include <fmt/format.h>

#include "physics/directions.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::mc {

namespace {
constexpr double above_nm = 1;              // of the highest surface
constexpr double shallowest_cosine = 1e-3;  // of a beam with -z
}  // namespace

Gun::Gun(const Beam& beam, const Scan& scan, double top_nm)
    : scan_(scan), center_{scan.center_x_nm, scan.center_y_nm, scan.center_z_nm},
      direction_(mc::direction(beam)), spot_nm_(beam.spot_nm),
      tan_convergence_(std::tan(beam.convergence_deg * degrees_to_radians)),
      focus_nm_(beam.focus_nm), working_distance_nm_(beam.working_distance_nm),
      start_nm_(top_nm + above_nm) {
  // x and y turned with the beam, by the smallest rotation from -z.
  const double k = 1.0 / (1.0 - direction_.z);
  const double dx = direction_.x, dy = direction_.y;
  across_ = {1.0 - dx * dx * k, -dx * dy * k, dx};
  up_ = {-dx * dy * k, 1.0 - dy * dy * k, dy};

  if (working_distance_nm_ > 0) {
    const double lens_nm = (center_ - direction_ * working_distance_nm_).z;
    if (lens_nm < start_nm_)
      throw UsageError(
          "`beam.working_distance`",
          fmt::format("{} from the middle of the scan is not above the specimen, whose "
                      "top is at z = {}",
                      format_length(working_distance_nm_), format_length(top_nm)),
          "Give a longer one: microscopes have millimetres");
  }
  // The steepest beam is at a corner, at the rim of the cone.
  for (const int column : {0, scan.width - 1})
    for (const int row : {0, scan.height - 1}) {
      const Vec3 d = middle(column, row).direction;
      const double polar = std::acos(-d.z) + beam.convergence_deg * degrees_to_radians;
      if (std::cos(polar) < shallowest_cosine)
        throw UsageError(
            "`beam.tilt`",
            "part of the beam, with its cone and perspective, would come from below or less than "
            "0.06 degrees above the horizon",
            "Choose a smaller tilt or convergence, or a longer working distance");
    }
}

Vec3 Gun::pixel(int column, int row) const {
  return in_plane((column + 0.5 - 0.5 * scan_.width) * scan_.pixel_x_nm,
                  (row + 0.5 - 0.5 * scan_.height) * scan_.pixel_y_nm);
}

Vec3 Gun::axis_at(const Vec3& in_plane) const {
  if (working_distance_nm_ == 0) return direction_;
  return normalized(in_plane - (center_ - direction_ * working_distance_nm_));
}

Gun::Start Gun::through(const Vec3& point, const Vec3& direction) const {
  return {point - direction * ((point.z - start_nm_) / direction.z), direction};
}

Gun::Start Gun::middle(int column, int row) const {
  const Vec3 p = pixel(column, row);
  return through(p, axis_at(p));
}

Gun::Start Gun::primary(int column, int row, RandomStream& random) const {
  const Vec3 center = pixel(column, row);
  const Vec3 axis = axis_at(center);
  Vec3 p = center;
  double s, c;
  if (spot_nm_ > 0) {
    const double r = spot_nm_ * std::sqrt(-2.0 * std::log(random.uniform()));
    sin_cos_turn(random.uniform(), s, c);
    p += across_ * (r * c) + up_ * (r * s);
  }
  if (tan_convergence_ == 0) return through(p, axis);
  // Evenly over the aperture; the spot is the cone's blurred tip.
  const double r = tan_convergence_ * std::sqrt(random.uniform());
  sin_cos_turn(random.uniform(), s, c);
  const Vec3 direction = normalized(axis + across_ * (r * c) + up_ * (r * s));
  return through(p - axis * focus_nm_, direction);
}

}  // namespace surf::mc
