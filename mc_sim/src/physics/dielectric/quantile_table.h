// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <span>
#include <vector>

namespace surf::mc {

/// Where the quantiles of a distribution with long tails are kept: their spacing shrinks towards both ends.
struct Quantiles {
  static constexpr int cells = 512;
  static constexpr int points = cells + 1;

  /// The share of probability below point i.
  static double probability(int i) {
    const double u = double(i) / cells;
    return u < 0.5 ? 2 * u * u : 1 - 2 * (1 - u) * (1 - u);
  }
  /// The place of a quantile among the points.
  static double place(double probability) {
    const double nearer = std::sqrt(0.5 * std::fmin(probability, 1 - probability));
    return (probability < 0.5 ? nearer : 1 - nearer) * cells;
  }
};

/// The quantiles of a density that is given by its integrals over steps: `sums[k]` is that up to `edges[k]`, from 0.
inline std::vector<double> quantiles_of(std::span<const double> edges, std::span<const double> sums) {
  std::vector<double> out(Quantiles::points);
  std::size_t k = 0;
  const std::size_t last = edges.size() - 1;
  std::size_t first = 0, end = last;   // where there is anything
  while (first + 1 < last && !(sums[first + 1] > 0)) ++first;
  while (end > first + 1 && !(sums[end - 1] < sums[last])) --end;
  out.front() = edges[first];
  out.back() = edges[end];
  k = first;
  for (int i = 1; i < Quantiles::cells; ++i) {
    const double wanted = Quantiles::probability(i) * sums[last];
    while (k + 1 < end && sums[k + 1] <= wanted) ++k;
    const double width = sums[k + 1] - sums[k];
    out[static_cast<std::size_t>(i)] = edges[k] + (width > 0 ? (wanted - sums[k]) / width : 0) * (edges[k + 1] - edges[k]);
  }
  return out;
}

}  // namespace surf::mc
