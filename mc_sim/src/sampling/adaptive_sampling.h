// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

// How many primaries a pixel gets where an accuracy is wanted: the workers that spend them and what
// foretells their number agree here.

inline constexpr std::int64_t pilot_primaries = 24;   ///< only tell how many it needs
inline constexpr std::int64_t fewest_primaries = 32;  ///< whose counts are kept
inline constexpr double reserve_of_primaries =
    1.1;                                    ///< over what the estimate of variance asks for
inline constexpr int pilot_neighbours = 2;  ///< pixels to each side whose pilots count with its own
inline constexpr int most_rounds = 8;       ///< of adding where the estimate turns out short,
inline constexpr double least_growth = 1.1;  ///< each by this factor or more

/// Sums of counts, from which come their mean and variance.
struct Sample {
  double n = 0, sum = 0, squares = 0, fourths = 0;
  void add(double value) {
    n += 1;
    sum += value;
    squares += value * value;
    fourths += value * value * value * value;
  }
  void operator+=(const Sample& b) {
    n += b.n;
    sum += b.sum;
    squares += b.squares;
    fourths += b.fourths;
  }
  double mean() const { return n > 0 ? sum / n : 0; }
  double variance() const { return n > 1 ? std::max(0.0, (squares - sum * sum / n) / (n - 1)) : 0; }
  /// The variance and its own standard error (from the fourth moment about 0: differences to a
  /// plane are mostly 0). Where few primaries make up most of it, it is badly known.
  double high_variance() const {
    if (!(n > 1)) return 0;
    const double v = variance(), second = squares / n;
    return v + std::sqrt(std::max(0.0, fourths / n - second * second) / n);
  }
  /// What may be missing in its variance. Were there a kind of event of which one in m primaries
  /// has one, m primaries would have missed it with a probability of 1/e^3 at 3/m (the rule of
  /// three). Each would count 1.5 electrons.
  double unseen_variance() const { return n > 0 ? 3 * 1.5 * 1.5 / (n * n) : 0; }
};

/// The standard error that is asked for, of a detector whose mean this is.
inline double wanted_error(const SimulationOptions& options, double mean) {
  return std::max(accuracy_of(options.budget) * mean, floor_of(options.budget));
}

/// Visits the numbers of the pixels whose pilots count with those of pixel `i` of a tile.
template <class Visit>
void for_pilots_near(std::size_t i, int width, int height, const Visit& visit) {
  const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
  for (int v = std::max(0, y - pilot_neighbours); v <= std::min(height - 1, y + pilot_neighbours);
       ++v)
    for (int u = std::max(0, x - pilot_neighbours); u <= std::min(width - 1, x + pilot_neighbours);
         ++u)
      visit(static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(u));
}

}  // namespace surf::mc
