// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/shape_guides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr double least_cosine = 0.05;
constexpr std::array<std::pair<double, double>, 3> scales{
    {{3, 1.5}, {8, 4}, {20, 10}}};  // nm, pixels
constexpr int sky_directions = 16;
constexpr std::array sky_steps{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};  // pixels
// A step: neighbours of which one is higher by more than this many pixel widths (63 degrees).
constexpr double step_pixels = 2;
constexpr double least_spot_px = 0.3;
constexpr double step_reach_nm = 5, step_reach_pixels = 2.5;

void check(const SeenSurface& s) {
  const bool same = s.height_nm.width() == s.cosine.width() &&
                    s.height_nm.height() == s.cosine.height() &&
                    s.height_nm.width() == s.seen.width() &&
                    s.height_nm.height() == s.seen.height() && !s.height_nm.empty();
  if (!same)
    throw InvalidInput("seen surface", "heights, cosines and what is seen have several sizes",
                       "Give all of one size");
  if (!(s.pixel_x_nm > 0 && s.pixel_y_nm > 0))
    throw InvalidInput("seen surface", "its pixels have no size", "Give a pixel size above zero");
}

/// 1 where something is seen, else 0.
Grid<double> weights_of(const SeenSurface& s) {
  Grid<double> weights(s.seen.width(), s.seen.height());
  std::ranges::transform(s.seen.data(), weights.data().begin(),
                         [](std::uint8_t seen) { return seen ? 1.0 : 0.0; });
  return weights;
}

Guide tilted_path(const SeenSurface& s) {
  Guide guide{"tilt", s.cosine};
  for (std::size_t i = 0; i < guide.values.size(); ++i)
    guide.values.data()[i] =
        s.seen.data()[i] ? 1 / std::max(std::abs(s.cosine.data()[i]), least_cosine) - 1 : 0;
  return guide;
}

/// How far a pixel lies above the mean around it, in units of the distance, at most 1.
Guide relative_height(const SeenSurface& s, double nm, double pixels) {
  const double pixel_nm = std::sqrt(s.pixel_x_nm * s.pixel_y_nm);
  const double distance_nm = std::max(nm, pixels * pixel_nm);
  const Grid<double> around = mean_around(s.height_nm, weights_of(s), distance_nm / pixel_nm);
  Guide guide{"height", Grid<double>(s.seen.width(), s.seen.height(), 0.0)};
  for (std::size_t i = 0; i < around.size(); ++i)
    if (s.seen.data()[i])
      guide.values.data()[i] = std::tanh((s.height_nm.data()[i] - around.data()[i]) / distance_nm);
  return guide;
}

/// The free share of the sky, weighed by the cosine of the angle to the beam.
Guide free_sky(const SeenSurface& s, int threads, const Watch& watch) {
  const int width = s.seen.width(), height = s.seen.height();
  Guide guide{"sky", Grid<double>(width, height, 0.0)};
  parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t row, int) {
    watch.check();
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      if (!s.seen(x, y)) continue;
      double sum = 0;
      for (int k = 0; k < sky_directions; ++k) {
        const double angle = 2 * std::numbers::pi * k / sky_directions;
        const double dx = std::cos(angle), dy = std::sin(angle);
        double steepest = 0;  // tangent of the horizon's elevation
        for (const int step : sky_steps) {
          const int u = x + static_cast<int>(std::lround(step * dx)),
                    v = y + static_cast<int>(std::lround(step * dy));
          if (u < 0 || v < 0 || u >= width || v >= height) break;
          if (!s.seen(u, v)) continue;
          const double away = std::hypot((u - x) * s.pixel_x_nm, (v - y) * s.pixel_y_nm);
          steepest = std::max(steepest, (s.height_nm(u, v) - s.height_nm(x, y)) / away);
        }
        sum += 1 / (1 + steepest * steepest);
      }
      guide.values(x, y) = sum / sky_directions;
    }
  });
  return guide;
}

/// Distances to the nearest pixel of a mask, in pixels: two passes over the image (Borgefors 1986,
/// doi:10.1016/S0734-189X(86)80047-0), within some percent of the Euclidean ones.
Grid<double> distances(const Grid<std::uint8_t>& mask) {
  const int width = mask.width(), height = mask.height();
  Grid<double> far(width, height, std::numeric_limits<double>::max());
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask.data()[i]) far.data()[i] = 0;
  const auto pass = [&](int x, int y, int sign) {
    double& here = far(x, y);
    for (const auto& [dx, dy, length] : {std::tuple{-1, 0, 1.0},
                                         {0, -1, 1.0},
                                         {-1, -1, std::numbers::sqrt2},
                                         {1, -1, std::numbers::sqrt2}}) {
      const int u = x + sign * dx, v = y + sign * dy;
      if (u >= 0 && v >= 0 && u < width && v < height) here = std::min(here, far(u, v) + length);
    }
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pass(x, y, 1);
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x) pass(x, y, -1);
  return far;
}

/// Nearness of steps: of those that the pixel lies above, or below.
Guide step_nearness(const SeenSurface& s, bool above) {
  const int width = s.seen.width(), height = s.seen.height();
  const double pixel_nm = std::sqrt(s.pixel_x_nm * s.pixel_y_nm);
  Grid<std::uint8_t> upper(width, height, 0), lower = upper;
  const auto compare = [&](int x, int y, int u, int v, double apart_nm) {
    const bool here = s.seen(x, y), there = s.seen(u, v);
    if (!here && !there) return;
    const double step = here && there ? s.height_nm(u, v) - s.height_nm(x, y)
                        : here        ? -std::numeric_limits<double>::infinity()
                                      : std::numeric_limits<double>::infinity();
    if (std::abs(step) <= step_pixels * apart_nm) return;
    (step > 0 ? lower : upper)(x, y) = 1;
    (step > 0 ? upper : lower)(u, v) = 1;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (x + 1 < width) compare(x, y, x + 1, y, s.pixel_x_nm);
      if (y + 1 < height) compare(x, y, x, y + 1, s.pixel_y_nm);
    }
  const Grid<double> own = distances(above ? upper : lower),
                     other = distances(above ? lower : upper);
  const double reach = std::max(step_reach_nm / pixel_nm, step_reach_pixels);
  Guide guide{above ? "step below" : "step above", Grid<double>(width, height, 0.0)};
  for (std::size_t i = 0; i < guide.values.size(); ++i)
    if (s.seen.data()[i] && own.data()[i] < other.data()[i])
      guide.values.data()[i] = std::exp(-own.data()[i] / reach);
  return guide;
}

}  // namespace

std::vector<Guide> shape_guides(const SeenSurface& surface, int threads, const Watch& watch) {
  check(surface);
  std::vector<Guide> guides{tilted_path(surface)};
  for (const auto& [nm, pixels] : scales) {
    watch.check();
    guides.push_back(relative_height(surface, nm, pixels));
    guides.back().name += " within " + std::to_string(static_cast<int>(nm)) + " nm";
  }
  guides.push_back(free_sky(surface, threads, watch));
  guides.push_back(step_nearness(surface, true));
  guides.push_back(step_nearness(surface, false));
  const double spot_px = surface.spot_nm / std::sqrt(surface.pixel_x_nm * surface.pixel_y_nm);
  if (spot_px > least_spot_px)
    for (Guide& guide : guides) {
      guide.values = mean_around(guide.values, weights_of(surface), spot_px);
      for (std::size_t i = 0; i < guide.values.size(); ++i)
        if (!surface.seen.data()[i]) guide.values.data()[i] = 0;
    }
  return guides;
}

}  // namespace surf
