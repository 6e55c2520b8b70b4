// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "physics/mechanisms.h"
#include "statistics.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

inline const Material& material(const char* name) { return io::find_material(name, "test"); }

/// Draws `n` events and counts a quantity in cells between `edges`; compares with the probability
/// below each edge.
inline void expect_sampled(const Scattering& mechanism, double energy_ev, int n,
                           const std::vector<double>& edges,
                           const std::function<double(const ScatterEvent&)>& quantity,
                           const std::function<double(double)>& probability_below,
                           std::size_t comparisons = 1, std::uint64_t seed = 1) {
  std::vector<std::int64_t> counts(edges.size() + 1);
  RandomStream random(seed, static_cast<std::uint64_t>(energy_ev), 0);
  for (int i = 0; i < n; ++i) {
    ScatterEvent event;
    mechanism.scatter(energy_ev, random, event);
    const double q = quantity(event);
    const auto cell = std::upper_bound(edges.begin(), edges.end(), q) - edges.begin();
    ++counts[static_cast<std::size_t>(cell)];
  }
  std::vector<double> expected;
  double below = 0;
  for (const double e : edges) {
    const double p = probability_below(e);
    expected.push_back(n * (p - below));
    below = p;
  }
  expected.push_back(n * (1 - below));
  test::expect_distributed(counts, expected, comparisons);
}

/// Integral by Simpson's rule on a logarithmic grid; 0 < a < b.
inline double integral(const std::function<double(double)>& f, double a, double b, int n = 4000) {
  const double h = std::log(b / a) / n;
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double x = a * std::exp(i * h);
    sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * f(x) * x;
  }
  return sum * h / 3;
}

}  // namespace surf::mc
