// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_budget.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surf/core/units.h"
#include "surf/mc/results/result_summary.h"
#include "surf/mc/sampling/expected_primaries.h"

namespace surf::workflow {
namespace {

constexpr double finest = 1e-4;
constexpr double reserve = 0.9;

std::size_t cascades_for(const mc::SimulationResult& result, double accuracy) {
  mc::SimulationOptions options;
  options.detectors = result.detectors;
  options.budget = mc::Accuracy{accuracy, mc::floor_of(result.budget)};
  return mc::library_size(options, 1, result.cascade_yields);
}

// Rounds to two digits, never to a better accuracy: "1.3%", read back as the parameter is.
double rounded_up(double accuracy) {
  const double percent = 100 * accuracy;
  const double step = std::pow(10.0, std::floor(std::log10(percent)) - 1);
  const double up = std::ceil(percent / step * (1 - 1e-9)) * step;
  return std::clamp(parse_share(fmt::format("{:.6g}%", up), "simulation.time"), finest,
                    coarse_accuracy);
}

}  // namespace

double accuracy_that_fits(const mc::SimulationResult& coarse, const TimeBudget& budget) {
  const auto planes = static_cast<double>(mc::planes_used(coarse));
  const auto work = [&](double primaries, std::size_t cascades) {
    return primaries + planes * static_cast<double>(cascades);
  };
  const double done = work(static_cast<double>(coarse.balance.incident), coarse.library_cascades);
  if (!(done > 0)) return coarse_accuracy;
  const double per_primary = coarse.seconds / done;
  const double per_cascade =
      budget.cascades_made > 0 ? coarse.library_seconds / static_cast<double>(budget.cascades_made)
                               : 0;
  const auto fits = [&](double accuracy) {
    const std::size_t cascades = cascades_for(coarse, accuracy);
    if (static_cast<double>(cascades) > budget.most_library_cascades) return false;
    const double more = static_cast<double>(budget.materials) *
                        (static_cast<double>(cascades) -
                         static_cast<double>(std::min(cascades, coarse.library_cascades)));
    const double seconds =
        per_primary * work(mc::expected_primaries(coarse, accuracy), cascades) + per_cascade * more;
    return seconds <= reserve * budget.seconds_left;
  };
  if (!fits(coarse_accuracy)) return coarse_accuracy;
  double low = finest, high = coarse_accuracy;  // `high` fits
  if (fits(low)) return low;
  while (high > low * 1.01) {
    const double middle = std::sqrt(low * high);
    (fits(middle) ? high : low) = middle;
  }
  return rounded_up(high);
}

}  // namespace surf::workflow
