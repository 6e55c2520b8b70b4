// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/find_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/changed_places.h"
#include "compare/noise_fields.h"
#include "compare/robust.h"
#include "compare/window_scores.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

constexpr int fewest_samples = 64;
constexpr int most_rounds = 200;       // of taking off what changed
constexpr double least_weight = 1e-3;  // smallest deviation, over the median one

double squared(double v) { return v * v; }

void check_grid(const Grid<double>& grid, const MeasuredDifference& m, const char* name,
                bool negative_too) {
  if (grid.width() != m.difference.width() || grid.height() != m.difference.height())
    throw InvalidInput(name, "it has another size than the difference", "Give one of each sample");
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (m.valid.includes(i) && (!(std::abs(grid.data()[i]) <= largest_raster_number) ||
                                (!negative_too && grid.data()[i] < 0)))
      throw InvalidInput(name,
                         fmt::format("sample {}, {} is {}", i % std::size_t(grid.width()),
                                     i / std::size_t(grid.width()), grid.data()[i]),
                         "Mark such samples as holes");
}

void check(const MeasuredDifference& m, const ChangeOptions& o) {
  validate(m.placement(), "difference");
  if (!m.valid.empty() &&
      (m.valid.width() != m.difference.width() || m.valid.height() != m.difference.height()))
    throw InvalidInput("difference", "its mask has another size", "Give one value of each sample");
  check_grid(m.difference, m, "difference", true);
  if (!m.deviation.empty()) check_grid(m.deviation, m, "deviation", false);
  if (!m.systematic.empty()) check_grid(m.systematic, m, "systematic error", false);
  for (const Grid<double>& pattern : m.common) check_grid(pattern, m, "common error", true);
  std::size_t samples = 0;
  for (std::size_t i = 0; i < m.difference.size(); ++i) samples += m.valid.includes(i);
  if (samples < fewest_samples)
    throw InvalidInput(
        "difference", fmt::format("only {} samples can be compared", samples),
        fmt::format("Give surfaces with at least {} samples in common", fewest_samples));
  if (!(o.false_alarms >= 0.001 && o.false_alarms <= 0.5))
    throw UsageError("`compare.false_alarms`", fmt::format("{} is out of range", o.false_alarms),
                     "Give a share from 0.1 % to 50 %");
  if (o.smallest_px < 1)
    throw UsageError("`compare.smallest_window`", fmt::format("{} is out of range", o.smallest_px),
                     "Give 1 or more samples");
  if (o.largest_nm && !(std::isfinite(*o.largest_nm) && *o.largest_nm > 0))
    throw UsageError("`compare.largest_window`", fmt::format("{} is out of range", *o.largest_nm),
                     "Give a length above 0");
  if (o.simulations < 0)
    throw UsageError("`compare.simulations`", fmt::format("{} is out of range", o.simulations),
                     "Give 0 or more");
  if (!(o.least_spread > 0 && o.least_spread <= 1))
    throw UsageError("least spread", fmt::format("{} is out of range", o.least_spread),
                     "Give a number above 0, up to 1");
}

std::vector<int> window_sizes(const MeasuredDifference& m, const ChangeOptions& o) {
  constexpr int most_by_default = 64;
  constexpr double step = 1.45;
  const int side = std::min(m.difference.width(), m.difference.height());
  int largest = std::min(side / 4, most_by_default);
  if (o.largest_nm)
    largest = int(std::min(double(side), *o.largest_nm / std::min(m.pitch_x_nm, m.pitch_y_nm)));
  const int smallest = std::min(o.smallest_px, side);
  std::vector<int> sizes;
  for (int size = smallest; size <= std::max(largest, smallest);
       size = std::max(size + 1, int(std::lround(step * size))))
    sizes.push_back(size);
  return sizes;
}

/// Errors that random numbers do not make, as a standard deviation.
Grid<double> other_errors(const MeasuredDifference& m) {
  Grid<double> out(m.difference.width(), m.difference.height());
  for (std::size_t i = 0; i < out.size(); ++i) {
    double variance = m.systematic.empty() ? 0 : squared(m.systematic.data()[i]);
    for (const Grid<double>& pattern : m.common) variance += squared(pattern.data()[i]);
    out.data()[i] = std::sqrt(variance);
  }
  return out;
}

/// Samples whose errors are random for the greater part: they tell how large and how correlated
/// random errors are.
Mask plain_samples(const MeasuredDifference& m, const Grid<double>& other) {
  constexpr double small_share = 0.5, least_kept = 0.1;
  Mask out(m.difference.width(), m.difference.height());
  std::vector<double> sizes;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!m.valid.includes(i)) continue;
    sizes.push_back(other.data()[i]);
    if (m.deviation.empty() || other.data()[i] > small_share * m.deviation.data()[i]) continue;
    out.data()[i] = 1, ++kept;
  }
  if (double(kept) >= least_kept * double(sizes.size())) return out;
  const double limit = median(sizes);
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = m.valid.includes(i) && other.data()[i] <= limit;
  return out;
}

/// Sets the random errors, and what is told of them.
void find_random_errors(const MeasuredDifference& m, const ChangeOptions& o,
                        DifferenceErrors& errors, Changes& out) {
  const Mask plain = plain_samples(m, other_errors(m));
  std::vector<double> ratios, deviations;
  Grid<double> ratio(m.difference.width(), m.difference.height());
  double largest = 0;
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    if (!m.valid.includes(i)) continue;
    largest = std::max(largest, std::abs(m.difference.data()[i]));
    const double deviation = m.deviation.empty() ? 1 : m.deviation.data()[i];
    if (!(deviation > 0)) continue;
    deviations.push_back(deviation);
    ratio.data()[i] = m.difference.data()[i] / deviation;
    if (plain.includes(i)) ratios.push_back(ratio.data()[i]);
  }
  // Without any noise the smallest steps of numbers are left.
  constexpr double rounding = 1e-7;
  const double floor = std::max(rounding * largest, 1e-30);
  double spread = ratios.empty() ? 0 : robust_deviation(ratios);
  if (m.deviation.empty()) {
    spread = std::max(spread, floor);
    out.estimated_deviation = spread;
  } else {
    out.spread = spread;
    spread = std::max(spread, o.least_spread);
  }
  const double usual = deviations.empty() ? 0 : median(deviations) * spread;
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    const double given = m.deviation.empty() ? 1 : m.deviation.data()[i];
    errors.random.data()[i] =
        m.valid.includes(i) ? std::max({given * spread, least_weight * usual, floor}) : 0;
  }
  if (o.correlation) {
    errors.correlation = *o.correlation;
    return;
  }
  constexpr int farthest = 24, shares = 5;
  const int reach = std::min({farthest, ratio.width() / shares, ratio.height() / shares});
  Mask used = plain;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!m.deviation.empty() && !(m.deviation.data()[i] > 0)) used.data()[i] = 0;
  errors.correlation = estimate_correlation(ratio, used, reach);
}

/// Correlation of errors that are alike over the largest window.
NoiseCorrelation alike_over(int size, int side) {
  const double length = 0.5 * size;
  const int reach = std::min(int(std::ceil(2.5 * length)), std::max(1, side / 2));
  NoiseCorrelation out{Grid<double>(2 * reach + 1, 2 * reach + 1)};
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      out.by_distance(reach + dx, reach + dy) =
          std::exp(-0.5 * (dx * dx + dy * dy) / (length * length));
  return out;
}

/// The largest score of each simulated field, ascending.
std::vector<double> largest_of_noise(const DifferenceErrors& e, const WindowScores& windows,
                                     int simulations, const ChangeOptions& o) {
  const int w = e.random.width(), h = e.random.height();
  const NoiseFields random(w, h, e.correlation);
  std::optional<NoiseFields> alike;
  if (!e.systematic.empty())
    alike.emplace(w, h, alike_over(windows.sizes().back(), std::min(w, h)));
  std::vector<double> most(static_cast<std::size_t>(simulations + 1) / 2 * 2);
  constexpr std::uint64_t own_numbers = std::uint64_t{1} << 40;  // others than of random errors
  parallel_for(
      most.size() / 2, o.threads,
      [&](std::size_t unit, int) {
        const auto noise = random.pair(o.seed, unit);
        std::array<Grid<float>, 2> shared;
        if (alike) shared = alike->pair(o.seed, own_numbers + unit);
        RandomStream numbers(o.seed, 2 * own_numbers + unit, 0);
        for (std::size_t k = 0; k < 2; ++k) {
          std::vector<double> of_patterns;
          for (std::size_t p = 0; p < e.common.size(); ++p) of_patterns.push_back(normal(numbers));
          most[2 * unit + k] = windows.largest([&](std::size_t i) {
            double d = e.random.data()[i] * double(noise[k].data()[i]);
            if (alike) d += e.systematic.data()[i] * double(shared[k].data()[i]);
            for (std::size_t p = 0; p < e.common.size(); ++p)
              d += e.common[p].data()[i] * of_patterns[p];
            return d;
          });
        }
      },
      o.watch);
  most.resize(static_cast<std::size_t>(simulations));
  std::ranges::sort(most);
  return most;
}

/// Takes the strongest windows off the difference until noise explains what is left. Marks their
/// samples with the scores. `left` starts as the difference.
Grid<double> take_off(Grid<double>& left, const WindowScores& windows, double threshold,
                      const Mask& valid, const Watch& watch) {
  const Grid<double> difference = left;
  const WindowScores::Sums whole = windows.sums_of(difference);
  Grid<double> score(left.width(), left.height());
  for (int round = 0; round < most_rounds; ++round) {
    watch.check();
    Grid<unsigned char> touched(left.width(), left.height());
    bool any = false;
    for (const Window& window : windows.above(left, threshold)) {
      // A window that reaches beyond a change leaves too little there, which is no change.
      if (windows.score(whole, window) * (window.score > 0 ? 1 : -1) < threshold) continue;
      const auto each = [&](const auto& use) {
        for (int y = window.y; y < window.y + window.size; ++y)
          for (int x = window.x; x < window.x + window.size; ++x)
            if (valid.includes(x, y)) use(x, y);
      };
      bool free = true;
      each([&](int x, int y) { free = free && !touched(x, y); });
      if (!free) continue;
      each([&](int x, int y) {
        touched(x, y) = 1;
        left(x, y) -= window.mean;
        if (std::abs(window.score) > std::abs(score(x, y))) score(x, y) = window.score;
      });
      any = true;
    }
    if (!any) break;
  }
  return score;
}

/// Unmarks samples of windows that are nearer to no change than to what was taken off, by means
/// over the smallest squares that can tell.
void trim(Grid<double>& score, Grid<double>& left, const Grid<double>& difference,
          const Grid<double>& deviation, const DifferenceErrors& errors) {
  constexpr double sigmas = 2;
  constexpr int largest = 9;
  const int w = score.width(), h = score.height();
  BoxSums sums(w, h), samples(w, h);
  sums.fill([&](std::size_t i) { return difference.data()[i]; });
  samples.fill([&](std::size_t i) { return double(errors.valid.data()[i]); });
  std::vector<double> inflation;
  for (int size = 1; size <= largest; size += 2)
    inflation.push_back(errors.correlation.inflation(size));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (score(x, y) == 0) continue;
      const double sign = score(x, y) > 0 ? 1 : -1;
      const double half = 0.5 * sign * (difference(x, y) - left(x, y));
      for (int size = 1; size <= largest; size += 2) {
        const double error = deviation(x, y) * std::sqrt(inflation[std::size_t(size / 2)]) / size;
        if (half > 0 && half < sigmas * error) continue;
        const int x0 = std::max(0, x - size / 2), x1 = std::min(w, x + size / 2 + 1),
                  y0 = std::max(0, y - size / 2), y1 = std::min(h, y + size / 2 + 1);
        if (half <= 0 || sign * sums.within(x0, y0, x1, y1) < half * samples.within(x0, y0, x1, y1))
          score(x, y) = 0;
        break;
      }
    }
  for (std::size_t i = 0; i < score.size(); ++i)
    if (score.data()[i] == 0) left.data()[i] = difference.data()[i];
}

}  // namespace

Changes find_changes(const MeasuredDifference& m, const ChangeOptions& o) {
  check(m, o);
  const int w = m.difference.width(), h = m.difference.height();
  Changes out;
  DifferenceErrors errors{Grid<double>(w, h), m.systematic, m.common, {}, Mask(w, h)};
  for (std::size_t i = 0; i < errors.valid.size(); ++i)
    errors.valid.data()[i] = m.valid.includes(i);
  Grid<double> left = m.difference;
  for (std::size_t i = 0; i < left.size(); ++i)
    if (!errors.valid.data()[i]) {  // whatever a hole holds
      left.data()[i] = 0;
      if (!errors.systematic.empty()) errors.systematic.data()[i] = 0;
      for (Grid<double>& pattern : errors.common) pattern.data()[i] = 0;
    }
  find_random_errors(m, o, errors, out);
  out.sizes_px = window_sizes(m, o);
  const WindowScores windows(errors, out.sizes_px);
  out.simulations =
      o.simulations > 0 ? o.simulations : std::max(400, int(std::ceil(20 / o.false_alarms)));
  out.simulations = std::max(out.simulations, int(std::ceil(1 / o.false_alarms)));
  const std::vector<double> noise = largest_of_noise(errors, windows, out.simulations, o);
  const auto p_of = [&](double score) {
    const auto reached = noise.end() - std::ranges::lower_bound(noise, score);
    return double(1 + reached) / double(noise.size() + 1);
  };
  // The smallest score whose p is not above what is asked for.
  const auto allowed = std::size_t(o.false_alarms * double(noise.size() + 1));
  const double noise_limit = noise[noise.size() - std::max<std::size_t>(allowed, 1)];
  out.threshold = std::nextafter(noise_limit, HUGE_VAL);

  const Grid<double> difference = left;
  out.deviation = errors.total();
  Grid<double> score = take_off(left, windows, out.threshold, errors.valid, o.watch);
  trim(score, left, difference, out.deviation, errors);
  const Grid<double> rest = windows.centred(left);
  out.probability = Grid<double>(w, h);
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (errors.valid.data()[i])
      out.probability.data()[i] =
          1 - p_of(score.data()[i] != 0 ? std::abs(score.data()[i])
                                        : std::min(rest.data()[i], noise_limit));
  out.place = Grid<int>(w, h);
  for (const ChangedRegion& region : connected_regions(score)) {
    out.places.push_back(describe_region(region, m, errors));
    out.places.back().probability = 1 - p_of(region.score);
    for (const std::size_t i : region.samples) out.place.data()[i] = int(out.places.size());
  }
  out.correlation = std::move(errors.correlation);
  return out;
}

}  // namespace surf
