// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/changed_places.h"

#include <algorithm>
#include <cmath>

namespace surf {

std::vector<ChangedRegion> connected_regions(const Grid<double>& score) {
  const int w = score.width(), h = score.height();
  Grid<unsigned char> seen(w, h);
  std::vector<ChangedRegion> regions;
  std::vector<std::pair<int, int>> open;
  for (int y0 = 0; y0 < h; ++y0)
    for (int x0 = 0; x0 < w; ++x0) {
      if (seen(x0, y0) || score(x0, y0) == 0) continue;
      ChangedRegion& region = regions.emplace_back();
      const bool up = score(x0, y0) > 0;
      open = {{x0, y0}};
      seen(x0, y0) = 1;
      while (!open.empty()) {
        const auto [x, y] = open.back();
        open.pop_back();
        region.samples.push_back(std::size_t(y) * std::size_t(w) + std::size_t(x));
        region.score = std::max(region.score, std::abs(score(x, y)));
        for (int v = std::max(0, y - 1); v <= std::min(h - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(w - 1, x + 1); ++u) {
            if (seen(u, v) || score(u, v) == 0 || (score(u, v) > 0) != up) continue;
            seen(u, v) = 1;
            open.emplace_back(u, v);
          }
      }
      std::ranges::sort(region.samples);
    }
  std::ranges::stable_sort(
      regions, [](const ChangedRegion& a, const ChangedRegion& b) { return a.score > b.score; });
  return regions;
}

namespace {

/// Variance of the sum of a region's differences.
double variance_of_sum(const std::vector<std::size_t>& samples, const DifferenceErrors& e) {
  const int w = e.random.width(), h = e.random.height();
  Grid<double> own(w, h);  // deviations within the region, 0 outside
  for (const std::size_t i : samples) own.data()[i] = e.random.data()[i];
  const int reach = e.correlation.by_distance.empty() ? 0 : e.correlation.reach();
  double variance = 0;
  for (const std::size_t i : samples) {
    const int x = int(i % std::size_t(w)), y = int(i / std::size_t(w));
    double sum = 0;
    for (int dy = std::max(-reach, -y); dy <= std::min(reach, h - 1 - y); ++dy)
      for (int dx = std::max(-reach, -x); dx <= std::min(reach, w - 1 - x); ++dx)
        sum += e.correlation.at(dx, dy) * own(x + dx, y + dy);
    variance += own(x, y) * sum;
  }
  const auto add = [&](const Grid<double>& pattern) {
    double sum = 0;
    for (const std::size_t i : samples) sum += pattern.data()[i];
    variance += sum * sum;
  };
  if (!e.systematic.empty()) add(e.systematic);
  for (const Grid<double>& pattern : e.common) add(pattern);
  return std::max(variance, 0.0);
}

}  // namespace

ChangedPlace describe_region(const ChangedRegion& region, const MeasuredDifference& m,
                             const DifferenceErrors& errors) {
  ChangedPlace place;
  const auto w = std::size_t(m.difference.width());
  const double n = double(region.samples.size()), sample_nm2 = m.pitch_x_nm * m.pitch_y_nm;
  double sum = 0, x = 0, y = 0;
  for (const std::size_t i : region.samples) {
    const double d = m.difference.data()[i];
    sum += d;
    x += double(i % w), y += double(i / w);
    if (std::abs(d) > std::abs(place.largest)) place.largest = d;
  }
  place.samples = int(region.samples.size());
  place.centre_nm = m.place_nm(x / n, y / n);
  place.area_nm2 = n * sample_nm2;
  place.mean = sum / n;
  place.volume = sum * sample_nm2;
  const double error = std::sqrt(variance_of_sum(region.samples, errors));
  place.mean_error = error / n;
  place.volume_error = error * sample_nm2;
  place.score = region.score;
  return place;
}

}  // namespace surf
