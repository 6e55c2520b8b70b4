// SPDX-License-Identifier: GPL-3.0-or-later
#include "grey_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace surf {
namespace {

constexpr std::size_t least_levels = 16, neighbours = 5;
constexpr std::int64_t least_pile = 10;

struct Level {
  double value;
  std::int64_t pixels;
};

std::vector<Level> levels_of(const Grid<double>& values, const Mask& valid) {
  std::vector<double> sorted;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (valid.includes(i)) sorted.push_back(values.data()[i]);
  std::ranges::sort(sorted);
  std::vector<Level> levels;
  for (const double v : sorted) {
    if (levels.empty() || v != levels.back().value) levels.push_back({v, 0});
    ++levels.back().pixels;
  }
  return levels;
}

/// The step between levels, if all of them are multiples of one step and have several pixels each.
double quantum_of(const std::vector<Level>& levels) {
  if (levels.size() < 2) return 0;
  double step = std::numeric_limits<double>::infinity();
  std::int64_t pixels = levels.front().pixels;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    step = std::min(step, levels[i].value - levels[i - 1].value);
    pixels += levels[i].pixels;
  }
  if (pixels < 2 * static_cast<std::int64_t>(levels.size())) return 0;
  const double range = levels.back().value - levels.front().value;
  step = range / std::round(range / step);  // for levels that were rounded themselves
  for (const Level& level : levels) {
    const double steps = (level.value - levels.front().value) / step;
    if (std::fabs(steps - std::round(steps)) > 1e-3) return 0;
  }
  return step;
}

bool is_pile(const std::vector<Level>& levels, bool top) {
  if (levels.size() < least_levels) return false;
  std::int64_t beside = 0;
  for (std::size_t i = 1; i <= neighbours; ++i)
    beside += levels[top ? levels.size() - 1 - i : i].pixels;
  const std::int64_t here = (top ? levels.back() : levels.front()).pixels;
  return here > least_pile &&
         static_cast<double>(here) > 3.0 * static_cast<double>(beside) / neighbours;
}

}  // namespace

GreyLevels grey_levels(const Grid<double>& values, const Mask& valid) {
  const std::vector<Level> levels = levels_of(values, valid);
  GreyLevels g;
  g.quantum = quantum_of(levels);
  if (is_pile(levels, false)) g.black = levels.front().value;
  if (is_pile(levels, true)) g.white = levels.back().value;
  return g;
}

}  // namespace surf
