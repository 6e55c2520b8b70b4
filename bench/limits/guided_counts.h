// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/core/distributions.h"
#include "surf/core/random.h"
#include "surf/sem/guided_estimate.h"

namespace surf::limits {

/// A random pattern of mean square 1 on 96 x 96 pixels, that changes over so many.
inline Grid<double> random_pattern(double correlation_px, std::uint64_t seed) {
  constexpr int pixels = 96;
  Grid<double> values(pixels, pixels), ones(pixels, pixels, 1.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    RandomStream random(seed, i, 0);
    values.data()[i] = std::sqrt(12.0) * (random.uniform() - 0.5);
  }
  values = mean_around(values, ones, correlation_px / std::sqrt(2.0));
  double squares = 0;
  for (const double value : values.data()) squares += value * value;
  const double scale = std::sqrt(static_cast<double>(values.size()) / squares);
  for (double& value : values.data()) value *= scale;
  return values;
}

/// What a detector counts of so many primaries per pixel, each of which sends it a Poisson number.
inline CountImage poisson_counts(const Grid<double>& yields, int primaries, std::uint64_t seed) {
  CountImage counts;
  for (std::size_t h = 0; h < 2; ++h) {
    counts[h] = {Grid<double>(yields.width(), yields.height(), primaries / 2.0),
                 Grid<double>(yields.width(), yields.height(), 0.0),
                 Grid<double>(yields.width(), yields.height(), 0.0)};
    for (std::size_t i = 0; i < yields.size(); ++i) {
      RandomStream random(seed, i, h);
      for (int k = 0; k < primaries / 2; ++k) {
        const auto n = static_cast<double>(poisson(yields.data()[i], random));
        counts[h].sum.data()[i] += n;
        counts[h].squares.data()[i] += n * n;
      }
    }
  }
  return counts;
}

inline Grid<double> plain_mean(const CountImage& counts, int primaries) {
  Grid<double> mean = counts[0].sum;
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean.data()[i] = (mean.data()[i] + counts[1].sum.data()[i]) / primaries;
  return mean;
}

/// Root mean square of how far values are from the truth, in percent of `mean`.
inline double rms_percent(const Grid<double>& values, const Grid<double>& truth, double mean) {
  double squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    squares += std::pow(values.data()[i] - truth.data()[i], 2);
  return 100 * std::sqrt(squares / static_cast<double>(truth.size())) / mean;
}

}  // namespace surf::limits
