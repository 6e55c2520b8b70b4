// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/mask.h"

namespace surf {
namespace {

/// An end that falls by less than this share of its reach is flat.
constexpr double flat_share = 1e-3;

struct Sample {
  double x, y, z;
};

/// Samples no deeper than `depth` that are connected to the apex through such samples.
std::vector<Sample> end_of(const Tip& tip, double depth) {
  Mask seen(tip.z_nm.width(), tip.z_nm.height(), 0);
  std::vector<std::pair<int, int>> open{{tip.apex_x, tip.apex_y}};
  seen(tip.apex_x, tip.apex_y) = 1;
  std::vector<Sample> out;
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    out.push_back(
        {(x - tip.apex_x) * tip.pitch_x_nm, (y - tip.apex_y) * tip.pitch_y_nm, tip.z_nm(x, y)});
    for (int v = std::max(0, y - 1); v <= std::min(y + 1, tip.z_nm.height() - 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(x + 1, tip.z_nm.width() - 1); ++u)
        if (!seen(u, v) && tip.z_nm(u, v) >= -depth) {
          seen(u, v) = 1;
          open.emplace_back(u, v);
        }
  }
  return out;
}

double depth_of_samples(const Tip& tip, std::size_t count) {
  std::vector<double> depths;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) depths.push_back(-z);
  std::sort(depths.begin(), depths.end());
  return std::max(depths[std::min(count, depths.size()) - 1], std::numeric_limits<double>::min());
}

/// Least squares by the normal equations of scaled columns; false if they are singular.
template <std::size_t N>
bool solve(const std::vector<std::array<double, N>>& rows, const std::vector<double>& right,
           std::array<double, N>& x) {
  std::array<std::array<double, N + 1>, N> a{};
  std::array<double, N> scale{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < N; ++i) scale[i] = std::max(scale[i], std::abs(row[i]));
  for (const double s : scale)
    if (!(s > 0)) return false;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) a[i][j] += rows[r][i] / scale[i] * rows[r][j] / scale[j];
      a[i][N] += rows[r][i] / scale[i] * right[r];
    }
  for (std::size_t p = 0; p < N; ++p) {
    std::size_t best = p;
    for (std::size_t i = p; i < N; ++i)
      if (std::abs(a[i][p]) > std::abs(a[best][p])) best = i;
    if (std::abs(a[best][p]) < 1e-11 * static_cast<double>(rows.size())) return false;
    std::swap(a[p], a[best]);
    for (std::size_t i = 0; i < N; ++i) {
      if (i == p) continue;
      const double f = a[i][p] / a[p][p];
      for (std::size_t j = p; j <= N; ++j) a[i][j] -= f * a[p][j];
    }
  }
  for (std::size_t i = 0; i < N; ++i) x[i] = a[i][N] / a[i][i] / scale[i];
  return true;
}

double radius_of(double curvature, double flat) {
  return std::abs(curvature) > flat ? 1 / curvature : std::numeric_limits<double>::infinity();
}

void fit_paraboloid(const std::vector<Sample>& samples, TipMeasures& out) {
  std::vector<std::array<double, 6>> rows;
  std::vector<double> depth;
  double reach = 0;
  for (const Sample& s : samples) {
    rows.push_back({1, s.x, s.y, s.x * s.x, s.x * s.y, s.y * s.y});
    depth.push_back(-s.z);
    reach = std::max(reach, std::hypot(s.x, s.y));
  }
  std::array<double, 6> c{};
  if (samples.size() < 6 || !solve(rows, depth, c))
    throw InvalidInput(
        "tip", fmt::format("its {} samples at the apex do not determine a radius", samples.size()),
        "Fit deeper, or use a tip with more pixels");
  double sum = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double left = -depth[i];
    for (std::size_t j = 0; j < 6; ++j) left += c[j] * rows[i][j];
    sum += left * left;
  }
  out.radius_residual_nm = std::sqrt(sum / static_cast<double>(rows.size()));
  const double mean = c[3] + c[5], half = std::hypot(c[3] - c[5], c[4]);
  // Rounding is no curvature.
  if (-std::ranges::min(samples, {}, &Sample::z).z < flat_share * reach) {
    out.radius_nm = out.smallest_radius_nm = out.largest_radius_nm =
        std::numeric_limits<double>::infinity();
    return;
  }
  const double flat = 1e-12 * std::max(1e-300, std::abs(mean) + half + 1e-3 / reach);
  out.radius_nm = radius_of(mean, flat);
  out.smallest_radius_nm = radius_of(mean + half, flat);
  out.largest_radius_nm = radius_of(mean - half, flat);
}

/// x^2 + y^2 + d^2 = linear in (x, y, d): the algebraic fit, exact for a sphere.
void fit_sphere(const std::vector<Sample>& samples, TipMeasures& out) {
  std::vector<std::array<double, 4>> rows;
  std::vector<double> squares;
  for (const Sample& s : samples) {
    rows.push_back({1, s.x, s.y, -s.z});
    squares.push_back(s.x * s.x + s.y * s.y + s.z * s.z);
  }
  std::array<double, 4> c{};
  out.sphere_radius_nm = std::numeric_limits<double>::infinity();
  if (!solve(rows, squares, c)) return;  // flat
  const double cx = c[1] / 2, cy = c[2] / 2, cd = c[3] / 2;
  const double square = c[0] + cx * cx + cy * cy + cd * cd;
  if (!(square > 0)) return;
  out.sphere_radius_nm = std::sqrt(square);
  double sum = 0;
  for (const Sample& s : samples) {
    const double rest = square - (s.x - cx) * (s.x - cx) - (s.y - cy) * (s.y - cy);
    const double left = cd - std::copysign(std::sqrt(std::max(0.0, rest)), cd) + s.z;
    sum += left * left;
  }
  out.sphere_residual_nm = std::sqrt(sum / static_cast<double>(samples.size()));
}

/// The depth of the highest sample at the rim: sections below it are cut off.
double rim_depth(const Tip& tip) {
  double highest = -std::numeric_limits<double>::infinity();
  const int w = tip.z_nm.width(), h = tip.z_nm.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (x == 0 || y == 0 || x == w - 1 || y == h - 1) highest = std::max(highest, tip.z_nm(x, y));
  double deepest = 0;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) deepest = std::max(deepest, -z);
  return std::min(-highest, deepest);
}

void fit_cone(const Tip& tip, double from, double to, TipMeasures& out) {
  constexpr int levels = 24;
  std::vector<std::array<double, 2>> rows;
  std::vector<double> radii;
  for (int i = 0; i < levels; ++i) {
    const double depth = from + (to - from) * (i + 0.5) / levels;
    const auto inside = std::count_if(tip.z_nm.data().begin(), tip.z_nm.data().end(),
                                      [&](double z) { return z >= -depth; });
    const double radius =
        std::sqrt(static_cast<double>(inside) * tip.pitch_x_nm * tip.pitch_y_nm / std::numbers::pi);
    rows.push_back({1, depth});
    radii.push_back(radius);
  }
  std::array<double, 2> c{};
  if (!(to > from) || !solve(rows, radii, c) || !(c[1] > 0)) return;
  out.half_angle_rad = std::atan(c[1]);
  double sum = 0;
  for (int i = 0; i < levels; ++i) sum += std::pow(c[0] + c[1] * rows[i][1] - radii[i], 2);
  out.half_angle_residual_nm = std::sqrt(sum / levels);
}

void check(const TipMeasureOptions& o) {
  for (const double depth : {o.fit_depth_nm, o.cone_from_nm, o.cone_to_nm})
    if (!(depth >= 0 && std::isfinite(depth)))
      throw InvalidInput("tip", fmt::format("a depth of {:g} nm cannot be fitted", depth),
                         "Give 0 nm or more");
}

}  // namespace

TipMeasures measure_tip(const Tip& tip, const TipMeasureOptions& options) {
  validate(tip);
  check(options);
  TipMeasures out;
  out.fit_depth_nm = options.fit_depth_nm > 0 ? options.fit_depth_nm : depth_of_samples(tip, 21);
  const std::vector<Sample> samples = end_of(tip, out.fit_depth_nm);
  out.samples = static_cast<int>(samples.size());
  fit_paraboloid(samples, out);
  fit_sphere(samples, out);
  const bool automatic = options.cone_from_nm == 0 && options.cone_to_nm == 0;
  fit_cone(tip, automatic ? out.fit_depth_nm : options.cone_from_nm,
           automatic ? rim_depth(tip) : options.cone_to_nm, out);
  return out;
}

double tip_volume_nm3(const Tip& tip, double depth_nm) {
  validate(tip);
  if (!(depth_nm > 0 && std::isfinite(depth_nm)))
    throw InvalidInput("tip", fmt::format("there is no volume within {:g} nm", depth_nm),
                       "Give a depth above 0 nm");
  double sum = 0;
  for (const double z : tip.z_nm.data()) sum += std::max(0.0, z + depth_nm);
  return sum * tip.pitch_x_nm * tip.pitch_y_nm;
}

}  // namespace surf
