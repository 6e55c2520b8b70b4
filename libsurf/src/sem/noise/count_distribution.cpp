// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/count_distribution.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "surf/afm/noise_check.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_expected = 25;

double below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// The probability of (from, to), accurate in both tails.
double between(double from, double to) {
  return from > 0 ? below(-from) - below(-to) : below(to) - below(from);
}

/// The standard normal number that corresponds to x.
double score(const LogNormalCounts& d, double x) {
  const double y = (x - d.median) / d.scale;
  if (d.shape < 1e-9) return y;
  return 1 + d.shape * y > 0 ? std::log1p(d.shape * y) / d.shape : -infinity;
}

template <class Distribution>
CountFit test(const CountHistogram& counts, const Distribution& distribution, int parameters) {
  std::int64_t trials = 0;
  for (const std::int64_t n : counts) trials += n;
  struct Cell {
    double seen = 0, expected = 0;
  };
  std::vector<Cell> cells(1);
  double rest = static_cast<double>(trials);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (cells.back().expected >= least_expected && rest >= least_expected) cells.emplace_back();
    const double expected =
        static_cast<double>(trials) * distribution.probability(static_cast<std::int64_t>(k));
    cells.back().seen += static_cast<double>(counts[k]);
    cells.back().expected += expected;
    rest -= expected;
  }
  cells.back().expected += std::max(rest, 0.0);  // counts larger than any observed one
  CountFit fit;
  for (const Cell& c : cells)
    fit.chi_squared += (c.seen - c.expected) * (c.seen - c.expected) / std::max(c.expected, 1e-12);
  fit.degrees = std::max(0, static_cast<int>(cells.size()) - 1 - parameters);
  fit.p = fit.degrees > 0 ? chi_squared_tail(fit.chi_squared, fit.degrees) : 1;
  return fit;
}

}  // namespace

double PoissonCounts::probability(std::int64_t count) const {
  if (count < 0) return 0;
  const double k = static_cast<double>(count);
  if (!(mean > 0)) return count == 0 ? 1 : 0;
  return std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
}

double LogNormalCounts::begin() const { return shape > 0 ? median - scale / shape : -infinity; }

double LogNormalCounts::probability(std::int64_t count) const {
  if (count < 0) return 0;
  const double k = static_cast<double>(count);
  return between(count == 0 ? -infinity : surf::score(*this, k - 0.5), surf::score(*this, k + 0.5));
}

double NormalCounts::probability(std::int64_t count) const {
  return LogNormalCounts{mean, std::sqrt(variance), 0}.probability(count);
}

CountMoments moments(const CountHistogram& counts) {
  CountMoments m;
  double sum = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] < 0)
      throw InvalidInput("counts", "a count was seen less than 0 times", "Give a histogram");
    m.trials += counts[k];
    sum += static_cast<double>(k) * static_cast<double>(counts[k]);
  }
  if (m.trials < 100)
    throw InvalidInput(
        "counts", fmt::format("{} trials are too few to say how counts are distributed", m.trials),
        "Make 100 or more");
  const double n = static_cast<double>(m.trials);
  m.mean = sum / n;
  double squares = 0, cubes = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double d = static_cast<double>(k) - m.mean, w = static_cast<double>(counts[k]);
    squares += w * d * d, cubes += w * d * d * d;
  }
  m.variance = squares / (n - 1);
  if (squares > 0) m.skewness = cubes / n / std::pow(squares / n, 1.5);
  return m;
}

PoissonCounts fit_poisson(const CountHistogram& counts) { return {moments(counts).mean}; }

NormalCounts fit_normal(const CountHistogram& counts) {
  const CountMoments m = moments(counts);
  if (!(m.variance > 0))
    throw InvalidInput("counts", "all trials gave the same count", "Use more primaries in a trial");
  const double rounding = 1.0 / 12;
  return {m.mean, m.variance > 2 * rounding ? m.variance - rounding : m.variance};
}

double log_likelihood(const CountHistogram& counts, const LogNormalCounts& distribution) {
  double sum = 0;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0)
      sum += static_cast<double>(counts[k]) *
             std::log(distribution.probability(static_cast<std::int64_t>(k)));
  return sum;
}

CountFit test_fit(const CountHistogram& counts, const PoissonCounts& d) {
  return test(counts, d, 1);
}
CountFit test_fit(const CountHistogram& counts, const LogNormalCounts& d) {
  return test(counts, d, 3);
}
CountFit test_fit(const CountHistogram& counts, const NormalCounts& d) {
  return test(counts, d, 2);
}

}  // namespace surf
