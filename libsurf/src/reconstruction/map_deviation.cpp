// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_deviation.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

namespace surf::reconstruction {
namespace {

using Numbers = Eigen::Matrix<double, 6, 1>;
using Matrix = Eigen::Matrix<double, 6, 6>;

// Ten small views (160 x 120 pixels, two detectors) chose these: maps are then off by 0.88 of their
// deviations, root mean square.
constexpr double patch_px = 100;   // samples that are displaced alike
constexpr double common_px = 0.3;  // what all walls of the middle or of an end are displaced by

/// Rotation, pixel sizes, shear, and where the image's middle lies.
Affine map_of(const Numbers& n, Point2 middle) {
  const Affine linear = make_affine({n[0], n[1], n[2], n[3], 0, 0});
  const Point2 at = linear(middle);
  return {linear.xx, linear.xy, n[4] - at.x, linear.yx, linear.yy, n[5] - at.y};
}

}  // namespace

MapDeviation map_deviation(const HeightField& surface, const Grid<double>& linear_nm,
                           const CommonDoubts& doubts, const Affine& sem_to_afm) {
  const int w = surface.z_nm.width(), h = surface.z_nm.height();
  const Point2 middle{0.5 * (surface.x_nm(0) + surface.x_nm(w - 1)),
                      0.5 * (surface.y_nm(0) + surface.y_nm(h - 1))};
  const Point2 there = sem_to_afm(middle);
  const AffineParts p = parts_of(sem_to_afm);
  const Numbers numbers{p.rotation_rad, p.scale_x, p.scale_y, p.shear, there.x, there.y};
  // By what a change of a number displaces the scan in the image's frame.
  const Affine back = inverse(sem_to_afm);
  std::array<Affine, 6> moved;
  constexpr double least = 1e-5;
  for (int k = 0; k < 6; ++k) {
    Numbers changed = numbers;
    changed[k] += least;
    moved[static_cast<std::size_t>(k)] = compose(back, map_of(changed, middle));
  }
  Matrix known = Matrix::Zero();
  for (int y = 1; y + 1 < h; ++y)
    for (int x = 1; x + 1 < w; ++x) {
      const double along =
                       (surface.z_nm(x + 1, y) - surface.z_nm(x - 1, y)) / (2 * surface.pitch_x_nm),
                   across =
                       (surface.z_nm(x, y + 1) - surface.z_nm(x, y - 1)) / (2 * surface.pitch_y_nm);
      const double by_wall = doubts.edge_px * surface.pitch_x_nm * std::hypot(along, across),
                   variance = linear_nm(x, y) * linear_nm(x, y) + by_wall * by_wall;
      if (!(variance > 0)) continue;
      const Point2 at{surface.x_nm(x), surface.y_nm(y)};
      Numbers by;
      for (int k = 0; k < 6; ++k) {
        const Point2 to = moved[static_cast<std::size_t>(k)](at);
        by[k] = (along * (to.x - at.x) + across * (to.y - at.y)) / least;
      }
      known += by * by.transpose() / (variance * patch_px);
    }
  // In units in which all numbers are about alike, so that what nothing holds is told from what
  // rounding left.
  Numbers unit = known.diagonal().cwiseSqrt();
  MapDeviation out;
  const auto set = [&](auto value) {
    out.rotation_rad = value(0), out.scale_x = value(1), out.scale_y = value(2);
    out.shear = value(3), out.middle_x_nm = value(4), out.middle_y_nm = value(5);
  };
  constexpr double nothing = 1e-9;
  if (!(unit.minCoeff() > 0)) {
    set([](int) { return std::numeric_limits<double>::infinity(); });
    return out;
  }
  const Matrix scaled = unit.cwiseInverse().asDiagonal() * known * unit.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> parts(scaled);
  set([&](int k) {
    double variance = 0;
    for (int i = 0; i < 6; ++i) {
      const double share = parts.eigenvectors()(k, i) * parts.eigenvectors()(k, i);
      if (parts.eigenvalues()[i] > nothing) variance += share / parts.eigenvalues()[i];
      else if (share > nothing) return std::numeric_limits<double>::infinity();
    }
    return std::sqrt(variance) / unit[k];
  });
  // What walls have in common, as a lean of the tip, grows towards the image's ends.
  const double beyond_x = common_px / (0.5 * w), beyond_y = common_px / (0.5 * h),
               turned = common_px / (0.5 * std::hypot(w, h)),
               moved_nm = common_px * surface.pitch_x_nm;
  out.rotation_rad = std::hypot(out.rotation_rad, turned);
  out.shear = std::hypot(out.shear, turned);
  out.scale_x = std::hypot(out.scale_x, beyond_x);
  out.scale_y = std::hypot(out.scale_y, beyond_y);
  out.middle_x_nm = std::hypot(out.middle_x_nm, moved_nm);
  out.middle_y_nm = std::hypot(out.middle_y_nm, moved_nm);
  // What everything may be displaced by, in the scan's frame.
  const double pixel2 = surface.pitch_x_nm * surface.pitch_x_nm;
  const auto along = [&](double x, double y) {
    return pixel2 * (x * x * doubts.place.along_x + 2 * x * y * doubts.place.both +
                     y * y * doubts.place.along_y);
  };
  out.middle_x_nm =
      std::sqrt(out.middle_x_nm * out.middle_x_nm + along(sem_to_afm.xx, sem_to_afm.xy));
  out.middle_y_nm =
      std::sqrt(out.middle_y_nm * out.middle_y_nm + along(sem_to_afm.yx, sem_to_afm.yy));
  return out;
}

}  // namespace surf::reconstruction
