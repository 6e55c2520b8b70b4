// SPDX-License-Identifier: GPL-3.0-or-later
#include "height_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/cubic_sample.h"
#include "surf/core/parallel.h"

namespace surf::reconstruction {
namespace {

constexpr std::size_t draws = 64;
constexpr double tail = 0.025;            // of the draws lie below, and as many above
constexpr double normal_quantile = 1.96;  // of a normal distribution
// What is not normal does not change quantiles where it is less than this share of a deviation.
constexpr double worth_mixing = 0.2;

/// Draws of two normal numbers, as evenly spread as can be: an additive recurrence (Roberts 2018,
/// "The unreasonable effectiveness of quasirandom sequences") through Box's and Muller's transform.
/// Each has its opposite. Mean squares are 1 and the covariance is 0.
std::array<Point2, draws> spread_draws() {
  constexpr double base = 1.3247179572447460;  // base^3 = base + 1
  std::array<Point2, draws> out;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < draws / 2; ++k) {
    const auto count = static_cast<double>(k + 1);
    const double far = std::sqrt(-2 * std::log(1 - std::fmod(0.5 + count / base, 1.0))),
                 turn = 2 * std::numbers::pi * std::fmod(0.5 + count / (base * base), 1.0);
    const Point2 draw{far * std::cos(turn), far * std::sin(turn)};
    out[2 * k] = out[2 * k + 1] = draw;
    xx += draw.x * draw.x, xy += draw.x * draw.y, yy += draw.y * draw.y;
  }
  constexpr double half = draws / 2;
  const double root = std::sqrt(xx / half), across = xy / xx,
               rest = std::sqrt((yy - xy * across) / half);
  for (std::size_t k = 0; k < draws; ++k) {
    const double sign = k % 2 == 0 ? 1 : -1;
    out[k] = {sign * out[k].x / root, sign * (out[k].y - across * out[k].x) / rest};
  }
  return out;
}

/// The same with the covariance of what everything and what walls may be displaced by.
std::array<Point2, draws> displacements(const CommonDoubts& doubts) {
  std::array<Point2, draws> out = spread_draws();
  const double edge = doubts.edge_px * doubts.edge_px;
  const double xx = doubts.place.along_x + edge, yy = doubts.place.along_y + edge;
  const double root = std::sqrt(std::max(xx, 0.0));
  const double common = root > 0 ? doubts.place.both / root : 0;
  const double rest = std::sqrt(std::max(yy - common * common, 0.0));
  for (Point2& d : out) d = {root * d.x, common * d.x + rest * d.y};
  return out;
}

/// Where `share` of the mean of normal distributions of this deviation about `means` lies below.
double mixture_quantile(const std::array<double, draws>& means, double deviation, double share,
                        double guess) {
  const auto [least, most] = std::ranges::minmax_element(means);
  double low = *least - 4 * deviation, high = *most + 4 * deviation;
  double at = std::clamp(guess, low, high);
  for (int i = 0; i < 40; ++i) {
    double below = 0, density = 0;
    for (const double mean : means) {
      const double t = (at - mean) / deviation;
      below += 0.5 * std::erfc(-t / std::numbers::sqrt2);
      density += std::exp(-0.5 * t * t);
    }
    below /= draws;
    density /= draws * deviation * std::sqrt(2 * std::numbers::pi);
    (below < share ? low : high) = at;
    const double step = (share - below) / std::max(density, std::numeric_limits<double>::min());
    const double next = at + step > low && at + step < high ? at + step : 0.5 * (low + high);
    if (std::abs(next - at) < 1e-3 * deviation) return next;
    at = next;
  }
  return at;
}

}  // namespace

HeightIntervals height_intervals(const CommonDoubts& doubts, const HeightField& surface,
                                 const Grid<double>& soft, const Affine& surface_to_afm,
                                 const Grid<double>& linear_nm, int threads) {
  const int w = soft.width(), h = soft.height();
  HeightIntervals out{Grid<double>(w, h), Grid<double>(w, h), Grid<double>(w, h)};
  const std::array<Point2, draws> drawn = displacements(doubts);
  parallel_for(static_cast<std::size_t>(h), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::array<double, draws> changes;
    for (int x = 0; x < w; ++x) {
      const Point2 p = surface_to_afm({surface.x_nm(x), surface.y_nm(y)});
      const double linear = std::sqrt(linear_nm(x, y) * linear_nm(x, y) +
                                      std::pow(doubts.level.x * (p.x - doubts.middle.x), 2) +
                                      std::pow(doubts.level.y * (p.y - doubts.middle.y), 2));
      double mean = 0, square = 0;
      for (std::size_t k = 0; k < draws; ++k) {
        const CubicSample there(std::clamp(x + drawn[k].x, 0.0, w - 1.0),
                                std::clamp(y + drawn[k].y, 0.0, h - 1.0), w, h);
        changes[k] = there.value(soft) - soft(x, y);
        mean += changes[k] / draws;
        square += changes[k] * changes[k] / draws;
      }
      const double z = surface.z_nm(x, y);
      out.deviation_nm(x, y) = std::sqrt(linear * linear + square);
      const double spread = std::sqrt(std::max(linear * linear + square - mean * mean, 0.0));
      double lower = mean - normal_quantile * spread, upper = mean + normal_quantile * spread;
      if (linear > 0 && square > worth_mixing * worth_mixing * linear * linear) {
        lower = mixture_quantile(changes, linear, tail, lower);
        upper = mixture_quantile(changes, linear, 1 - tail, upper);
      }
      out.lower_nm(x, y) = z + lower;
      out.upper_nm(x, y) = z + upper;
    }
  });
  return out;
}

}  // namespace surf::reconstruction
