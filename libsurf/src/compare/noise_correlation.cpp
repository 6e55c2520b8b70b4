// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/noise_correlation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "compare/robust.h"

namespace surf {

double NoiseCorrelation::at(int dx, int dy) const {
  if (by_distance.empty()) return dx == 0 && dy == 0 ? 1 : 0;
  const int r = reach();
  if (std::abs(dx) > r || std::abs(dy) > r) return 0;
  return by_distance(r + dx, r + dy);
}

double NoiseCorrelation::inflation(int size) const {
  const int r = by_distance.empty() ? 0 : std::min(reach(), size - 1);
  double sum = 0;
  for (int dy = -r; dy <= r; ++dy)
    for (int dx = -r; dx <= r; ++dx)
      sum += at(dx, dy) * (size - std::abs(dx)) * (size - std::abs(dy));
  return sum / (double(size) * size);
}

namespace {

/// Signs about the median: -1, 1, or 0 for samples that do not count.
Grid<signed char> signs_of(const Grid<double>& values, const Mask& used) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (used.includes(i)) kept.push_back(values.data()[i]);
  Grid<signed char> signs(values.width(), values.height());
  if (kept.empty()) return signs;
  const double middle = median(kept);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (used.includes(i))
      signs.data()[i] =
          static_cast<signed char>((values.data()[i] > middle) - (values.data()[i] < middle));
  return signs;
}

struct SignMean {
  double mean = 0, pairs = 0;
};

SignMean mean_product(const Grid<signed char>& signs, int dx, int dy) {
  long sum = 0, pairs = 0;
  const int w = signs.width(), h = signs.height();
  const int x0 = std::max(0, -dx), x1 = std::min(w, w - dx);
  for (int y = 0; y < h - dy; ++y)
    for (int x = x0; x < x1; ++x) {
      const int product = signs(x, y) * signs(x + dx, y + dy);
      sum += product, pairs += product != 0;
    }
  return {pairs > 0 ? double(sum) / double(pairs) : 0, double(pairs)};
}

}  // namespace

NoiseCorrelation estimate_correlation(const Grid<double>& values, const Mask& used, int reach) {
  constexpr double sigmas = 3;
  constexpr double fewest_pairs = 100;
  const Grid<signed char> signs = signs_of(values, used);
  Grid<double> found(2 * reach + 1, 2 * reach + 1);
  found(reach, reach) = 1;
  bool any = false;
  for (int dy = 0; dy <= reach; ++dy)
    for (int dx = dy == 0 ? 1 : -reach; dx <= reach; ++dx) {
      const SignMean m = mean_product(signs, dx, dy);
      if (m.pairs < fewest_pairs || m.mean * std::sqrt(m.pairs) < sigmas) continue;
      const double correlation = std::sin(0.5 * std::numbers::pi * m.mean);
      found(reach + dx, reach + dy) = found(reach - dx, reach - dy) = correlation;
      any = true;
    }
  return any ? NoiseCorrelation{std::move(found)} : NoiseCorrelation{};
}

}  // namespace surf
