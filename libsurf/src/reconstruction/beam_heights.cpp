// SPDX-License-Identifier: GPL-3.0-or-later
#include "beam_heights.h"

#include <algorithm>
#include <cmath>

#include "core/cubic_sample.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"

namespace surf {

BeamAxes beam_axes(double tilt_deg, double azimuth_deg) {
  const double t = tilt_deg * degrees_to_radians, a = azimuth_deg * degrees_to_radians;
  const Vec3 d{std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), -std::cos(t)};
  const double k = 1 / (1 - d.z);
  return {{1 - d.x * d.x * k, -d.x * d.y * k, d.x}, {-d.x * d.y * k, 1 - d.y * d.y * k, d.y}, -d};
}

namespace reconstruction {
namespace {

constexpr double step_px = 0.5;        // along the surface, in search of what a beam meets first
constexpr double least_facing = 0.05;  // a beam that grazes a wall would make any change of it huge

struct Tilt {
  double x = 0, y = 0;  // degrees
};

Tilt tilt_of(const ViewPose& p) {
  const double a = p.azimuth_deg * degrees_to_radians;
  return {p.tilt_deg * std::cos(a), p.tilt_deg * std::sin(a)};
}

BeamAxes axes_of(const Tilt& t) {
  return beam_axes(std::hypot(t.x, t.y), std::atan2(t.y, t.x) / degrees_to_radians);
}

/// (b - a) / by
BeamAxes slope(const BeamAxes& a, const BeamAxes& b, double by) {
  return {(b.across - a.across) * (1 / by), (b.up - a.up) * (1 / by),
          (b.against - a.against) * (1 / by)};
}

double reach_of(const SurfaceFrame& view) {
  return 0.5 * view.pitch_nm * std::max(view.width, view.height);
}
Point2 middle_of(const SurfaceFrame& view) {
  return {view.origin_x_nm + 0.5 * view.pitch_nm * (view.width - 1),
          view.origin_y_nm + 0.5 * view.pitch_nm * (view.height - 1)};
}

/// The surface with its slopes, at places in samples.
struct Ground {
  const SurfaceFrame& frame;
  const Grid<double>& z;

  CubicSample at(Point2& samples) const {
    samples = {std::clamp(samples.x, 0.0, frame.width - 1.0),
               std::clamp(samples.y, 0.0, frame.height - 1.0)};
    return {samples.x, samples.y, frame.width, frame.height};
  }
};

}  // namespace

ViewPose changed(const ViewPose& pose, const SurfaceFrame& view, const PoseChange& by) {
  ViewPose out = pose;
  const double reach = reach_of(view), p = view.pitch_nm;
  const Point2 m = middle_of(view);
  Affine& a = out.to_plane;
  a.xx += p * by[1] / reach, a.xy += p * by[2] / reach;
  a.x0 += p * (by[0] - (by[1] * m.x + by[2] * m.y) / reach);
  a.yx += p * by[4] / reach, a.yy += p * by[5] / reach;
  a.y0 += p * (by[3] - (by[4] * m.x + by[5] * m.y) / reach);
  if (by[pose_tilt] == 0 && by[pose_tilt + 1] == 0) return out;
  Tilt t = tilt_of(pose);
  t.x += by[pose_tilt], t.y += by[pose_tilt + 1];
  out.tilt_deg = std::hypot(t.x, t.y);
  out.azimuth_deg = std::atan2(t.y, t.x) / degrees_to_radians;
  return out;
}

BeamHeights::BeamHeights(const SurfaceFrame& surface, const Grid<double>& z, const ViewPose& pose,
                         const SurfaceFrame& view, int threads)
    : surface_(surface), view_(view), heights_(view.width, view.height),
      hits_(view.width, view.height) {
  constexpr double turn_deg = 1e-3;
  const Tilt tilt = tilt_of(pose);
  const BeamAxes axes = axes_of(tilt),
                 by_x = slope(axes_of({tilt.x - turn_deg, tilt.y}),
                              axes_of({tilt.x + turn_deg, tilt.y}), 2 * turn_deg),
                 by_y = slope(axes_of({tilt.x, tilt.y - turn_deg}),
                              axes_of({tilt.x, tilt.y + turn_deg}), 2 * turn_deg);
  const auto [lowest, highest] = std::ranges::minmax_element(z.data());
  // Cubic interpolation may exceed the samples.
  const double over = 0.1 * (*highest - *lowest) + 1e-3, top = *highest + over,
               bottom = *lowest - over;
  const Vec3& n = axes.against;
  const double aside_px = (top - bottom) / n.z * std::hypot(n.x, n.y) / surface.pitch_nm;
  const int steps = 1 + static_cast<int>(std::ceil(aside_px / step_px));
  const Ground ground{surface, z};
  parallel_for(static_cast<std::size_t>(view.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < view.width; ++x) {
      const Point2 p = pose.to_plane(
          {view.origin_x_nm + x * view.pitch_nm, view.origin_y_nm + y * view.pitch_nm});
      const Vec3 foot = axes.across * p.x + axes.up * p.y;
      const auto place = [&](double c) {
        return surface.to_samples({foot.x + c * n.x, foot.y + c * n.y});
      };
      const auto above = [&](double c) {  // how far the beam's point is above the surface
        Point2 s = place(c);
        return foot.z + c * n.z - ground.at(s).value(z);
      };
      double high = (top - foot.z) / n.z, high_value = above(high), low = high, low_value = 0;
      for (int k = 1; k <= steps; ++k) {
        low = (top + (bottom - top) * k / steps - foot.z) / n.z;
        low_value = above(low);
        if (low_value <= 0) break;
        high = low, high_value = low_value;
      }
      // Regula falsi with halved weights (Illinois).
      int side = 0;
      double c = low;
      for (int k = 0; k < 60 && high - low > 1e-10 * (1 + std::fabs(high)); ++k) {
        c = (low * high_value - high * low_value) / (high_value - low_value);
        const double v = above(c);
        if (v == 0) break;
        if (v > 0) {
          high = c, high_value = v;
          if (side == 1) low_value *= 0.5;
          side = 1;
        } else {
          low = c, low_value = v;
          if (side == -1) high_value *= 0.5;
          side = -1;
        }
        if (std::fabs(v) < 1e-11) break;
      }
      heights_(x, y) = c;
      Hit& hit = hits_(x, y);
      hit.at = place(c);
      const Point2 wanted = hit.at;
      const CubicSample there = ground.at(hit.at);
      const double gx = wanted.x == hit.at.x ? there.slope_x(z) / surface.pitch_nm : 0,
                   gy = wanted.y == hit.at.y ? there.slope_y(z) / surface.pitch_nm : 0;
      // The derivative of `above` as the point moves by v.
      const auto along = [&](const Vec3& v) { return v.z - gx * v.x - gy * v.y; };
      hit.rise = 1 / std::max(along(n), least_facing);
      hit.across = -along(axes.across) * hit.rise;
      hit.up = -along(axes.up) * hit.rise;
      const auto turned = [&](const BeamAxes& by) {
        return -along(by.across * p.x + by.up * p.y + by.against * c) * hit.rise;
      };
      hit.by_tilt_x = turned(by_x);
      hit.by_tilt_y = turned(by_y);
    }
  });
}

bool BeamHeights::meets(int x, int y) const {
  constexpr double rim_px = 2;
  const Point2 at = hits_(x, y).at;
  return at.x >= rim_px && at.y >= rim_px && at.x <= surface_.width - 1 - rim_px &&
         at.y <= surface_.height - 1 - rim_px;
}

Grid<double> BeamHeights::change(const Grid<double>& dz) const {
  Grid<double> out(view_.width, view_.height);
  for (int y = 0; y < view_.height; ++y)
    for (int x = 0; x < view_.width; ++x) {
      const Hit& h = hits_(x, y);
      out(x, y) = h.rise * CubicSample(h.at.x, h.at.y, surface_.width, surface_.height).value(dz);
    }
  return out;
}

void BeamHeights::scatter(const Grid<double>& weights, Grid<double>& out) const {
  for (int y = 0; y < view_.height; ++y)
    for (int x = 0; x < view_.width; ++x) {
      const Hit& h = hits_(x, y);
      CubicSample(h.at.x, h.at.y, surface_.width, surface_.height)
          .scatter(h.rise * weights(x, y), out);
    }
}

PoseChange BeamHeights::numbers(int x, int y) const {
  const Hit& h = hits_(x, y);
  const double half = 0.5 * std::max(view_.width, view_.height),
               u = (x - 0.5 * (view_.width - 1)) / half, v = (y - 0.5 * (view_.height - 1)) / half,
               across = h.across * view_.pitch_nm, up = h.up * view_.pitch_nm;
  return {across, across * u, across * v, up, up * u, up * v, h.by_tilt_x, h.by_tilt_y};
}

Grid<double> BeamHeights::change(const PoseChange& pose) const {
  Grid<double> out(view_.width, view_.height);
  for (int y = 0; y < view_.height; ++y)
    for (int x = 0; x < view_.width; ++x) {
      const PoseChange by = numbers(x, y);
      for (int k = 0; k < pose_numbers; ++k) out(x, y) += by[k] * pose[k];
    }
  return out;
}

PoseChange BeamHeights::by_pose(const Grid<double>& weights) const {
  PoseChange out{};
  for (int y = 0; y < view_.height; ++y)
    for (int x = 0; x < view_.width; ++x) {
      const PoseChange by = numbers(x, y);
      for (int k = 0; k < pose_numbers; ++k) out[k] += by[k] * weights(x, y);
    }
  return out;
}

}  // namespace reconstruction

HeightField heights_along_beam(const HeightField& surface, const PlacedImage& image,
                               const ViewPose& pose, int margin, int threads) {
  validate(surface, "surface");
  const bool holes = std::ranges::any_of(surface.valid.data(), [](auto v) { return v == 0; });
  if (holes || std::fabs(surface.pitch_x_nm / surface.pitch_y_nm - 1) > 1e-3)
    throw InvalidInput("surface", "a tilted beam needs one without holes, of square samples",
                       "Resample it");
  const double p = image.pitch_x_nm;
  const reconstruction::SurfaceFrame ground{surface.z_nm.width(), surface.z_nm.height(),
                                            surface.pitch_x_nm, surface.origin_x_nm,
                                            surface.origin_y_nm},
      view{image.values.width() + 2 * margin, image.values.height() + 2 * margin, p,
           image.origin_x_nm - margin * p, image.origin_y_nm - margin * p};
  const reconstruction::BeamHeights seen(ground, surface.z_nm, pose, view, threads);
  HeightField out = view.field(seen.heights());
  out.valid = Mask(view.width, view.height);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) out.valid(x, y) = seen.meets(x, y);
  return out;
}

}  // namespace surf
