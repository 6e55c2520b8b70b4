// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/surface_difference.h"

#include <algorithm>
#include <cmath>

#include "compare/robust.h"
#include "core/cubic_sample.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int fewest_samples = 64;

/// The place of a sample of `before` in columns and rows of `after`.
Point2 place_in(const HeightField& before, const HeightField& after, const SurfaceAlignment& a,
                int x, int y) {
  return {(before.x_nm(x) - a.shift_nm.x - after.origin_x_nm) / after.pitch_x_nm,
          (before.y_nm(y) - a.shift_nm.y - after.origin_y_nm) / after.pitch_y_nm};
}

bool inside(const HeightField& field, Point2 place) {
  constexpr double rounding = 1e-9;
  return place.x >= -rounding && place.y >= -rounding &&
         place.x <= field.z_nm.width() - 1 + rounding &&
         place.y <= field.z_nm.height() - 1 + rounding;
}

bool whole(const HeightField& field, const CubicSample& at) {
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (!field.is_valid(at.column[i], at.row[j])) return false;
  return true;
}

/// Largest second differences along x and y of the lines that a place is interpolated from.
Point2 bend(const Grid<double>& z, const CubicSample& at) {
  Point2 out;
  for (int k = 1; k < 3; ++k)
    for (int i = 1; i < 3; ++i) {
      const auto second = [](double a, double b, double c) { return std::abs(a - 2 * b + c); };
      out.x = std::max(out.x, second(z(at.column[i - 1], at.row[k]), z(at.column[i], at.row[k]),
                                     z(at.column[i + 1], at.row[k])));
      out.y = std::max(out.y, second(z(at.column[k], at.row[i - 1]), z(at.column[k], at.row[i]),
                                     z(at.column[k], at.row[i + 1])));
    }
  return out;
}

/// The error of interpolation between samples a fraction f apart. Of a wall that is narrower than
/// samples lie apart it has the deviation sqrt(f (1 - f)) of the wall's height, which second
/// differences show: it lies anywhere between two samples. Of smooth shapes the error is much less
/// than this, but so are second differences. The factor was chosen on made-up walls
/// (bench/bench_compare.cpp).
double interpolation_error(Point2 place, Point2 bend) {
  constexpr double factor = 0.8;
  const auto part = [](double at, double second) {
    const double f = at - std::floor(at);
    return std::sqrt(f * (1 - f)) * second;
  };
  return factor * std::hypot(part(place.x, bend.x), part(place.y, bend.y));
}

/// Takes off what noise makes of the error everywhere.
void take_noise_off(Grid<double>& error, const Mask& valid) {
  constexpr double times_usual = 2.5;
  std::vector<double> values;
  for (std::size_t i = 0; i < error.size(); ++i)
    if (valid.includes(i)) values.push_back(error.data()[i]);
  const double noise = times_usual * median(values);
  for (double& e : error.data()) e = std::max(0.0, e - noise);
}

/// The largest of each sample and its eight neighbours.
Grid<double> widened(const Grid<double>& grid) {
  Grid<double> out = grid;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      for (int v = std::max(0, y - 1); v <= std::min(grid.height() - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(grid.width() - 1, x + 1); ++u)
          out(x, y) = std::max(out(x, y), grid(u, v));
  return out;
}

/// Lower triangle L of L L' = covariance; a number without variance has a row of zeros.
std::array<double, 25> root_of(const std::array<double, 25>& c) {
  std::array<double, 25> l{};
  for (int j = 0; j < 5; ++j) {
    const auto at = [](int row, int column) { return std::size_t(5 * row + column); };
    double d = c[at(j, j)];
    for (int k = 0; k < j; ++k) d -= l[at(j, k)] * l[at(j, k)];
    if (!(d > 1e-12 * c[at(j, j)])) continue;
    l[at(j, j)] = std::sqrt(d);
    for (int i = j + 1; i < 5; ++i) {
      double s = c[at(i, j)];
      for (int k = 0; k < j; ++k) s -= l[at(i, k)] * l[at(j, k)];
      l[at(i, j)] = s / l[at(j, j)];
    }
  }
  return l;
}

}  // namespace

SurfaceDifference surface_difference(const HeightField& before, const HeightField& after,
                                     const SurfaceAlignment& a) {
  const int w = before.z_nm.width(), h = before.z_nm.height();
  SurfaceDifference out;
  out.placement() = before.placement();
  out.difference_nm = out.interpolation_nm = Grid<double>(w, h);
  out.valid = Mask(w, h);
  const auto root = root_of(a.covariance);
  out.common_nm.assign(5, Grid<double>(w, h));
  int samples = 0;
  double shares = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const Point2 place = place_in(before, after, a, x, y);
      if (!before.is_valid(x, y) || !inside(after, place)) continue;
      const CubicSample at(place.x, place.y, after.z_nm.width(), after.z_nm.height());
      if (!whole(after, at)) continue;
      out.valid(x, y) = 1;
      ++samples;
      const double dx = before.x_nm(x) - a.centre_nm.x, dy = before.y_nm(y) - a.centre_nm.y;
      out.difference_nm(x, y) =
          at.value(after.z_nm) - before.z_nm(x, y) - a.lift_nm - a.tilt_x * dx - a.tilt_y * dy;
      const double slope_x = at.slope_x(after.z_nm) / after.pitch_x_nm,
                   slope_y = at.slope_y(after.z_nm) / after.pitch_y_nm;
      out.interpolation_nm(x, y) = std::hypot(interpolation_error(place, bend(after.z_nm, at)),
                                              a.place_error_px * before.pitch_x_nm * slope_x,
                                              a.place_error_px * before.pitch_y_nm * slope_y);
      const std::array<double, 5> by{-slope_x, -slope_y, -1, -dx, -dy};
      for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t j = k; j < 5; ++j) out.common_nm[k](x, y) += by[j] * root[5 * j + k];
      double wx = 0, wy = 0;
      for (int i = 0; i < 4; ++i) wx += at.wx[i] * at.wx[i], wy += at.wy[i] * at.wy[i];
      shares += wx * wy;
    }
  if (samples < fewest_samples)
    throw InvalidInput("surfaces", "hardly any of their samples lie on each other",
                       "Give surfaces that show more of the same place");
  out.averaged_share = std::sqrt(std::min(1.0, shares / samples));
  std::erase_if(out.common_nm, [](const Grid<double>& pattern) {
    return std::ranges::all_of(pattern.data(), [](double v) { return v == 0; });
  });
  out.interpolation_nm = widened(out.interpolation_nm);
  take_noise_off(out.interpolation_nm, out.valid);
  return out;
}

Grid<double> moved_deviation(const HeightField& before, const HeightField& after,
                             const Grid<double>& deviation, const SurfaceAlignment& a) {
  Grid<double> out(before.z_nm.width(), before.z_nm.height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Point2 place = place_in(before, after, a, x, y);
      if (!inside(after, place)) continue;
      const CubicSample at(place.x, place.y, deviation.width(), deviation.height());
      for (int j = 1; j < 3; ++j)
        for (int i = 1; i < 3; ++i)
          out(x, y) = std::max(out(x, y), deviation(at.column[i], at.row[j]));
    }
  return out;
}

}  // namespace surf
