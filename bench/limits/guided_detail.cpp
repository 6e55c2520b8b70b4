// SPDX-License-Identifier: GPL-3.0-or-later
// Guided images of yields that change ever faster, without a guide, with one that is right but for
// a factor, and with one that lies.
#include <cmath>

#include "surf/core/distributions.h"
#include "surf/core/random.h"
#include "surf/sem/guided_estimate.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int pixels = 96, primaries = 64;

/// A random pattern of variance 1 that changes over so many pixels.
Grid<double> pattern(double correlation_px, std::uint64_t seed) {
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

CountImage counts_of(const Grid<double>& yields) {
  CountImage counts;
  for (std::size_t h = 0; h < 2; ++h) {
    counts[h] = {Grid<double>(pixels, pixels, primaries / 2.0), Grid<double>(pixels, pixels, 0.0),
                 Grid<double>(pixels, pixels, 0.0)};
    for (std::size_t i = 0; i < yields.size(); ++i) {
      RandomStream random(11, i, h);
      for (int k = 0; k < primaries / 2; ++k) {
        const auto n = static_cast<double>(poisson(yields.data()[i], random));
        counts[h].sum.data()[i] += n;
        counts[h].squares.data()[i] += n * n;
      }
    }
  }
  return counts;
}

double percent(const Grid<double>& errors) {
  double squares = 0;
  for (const double error : errors.data()) squares += error * error;
  return 100 * std::sqrt(squares / static_cast<double>(errors.size())) / 0.5;
}

std::vector<double> at(double correlation_px) {
  Grid<double> yields = pattern(correlation_px, 1);
  for (double& value : yields.data()) value = 0.5 * std::exp(0.3 * value - 0.045);
  const CountImage counts = counts_of(yields);
  Guide right{"right", yields, true}, lie{"lie", pattern(correlation_px, 2), true};
  for (double& value : right.values.data()) value = 0.1 + 0.7 * value;
  const auto off = [&](const Grid<double>& mean) {
    Grid<double> errors = mean;
    for (std::size_t i = 0; i < errors.size(); ++i) errors.data()[i] -= yields.data()[i];
    return percent(errors);
  };
  Grid<double> plain = counts[0].sum;
  for (std::size_t i = 0; i < plain.size(); ++i)
    plain.data()[i] = (plain.data()[i] + counts[1].sum.data()[i]) / primaries;
  std::vector<double> row{off(plain)};
  for (const std::vector<Guide>& guides :
       {std::vector<Guide>{}, std::vector<Guide>{right}, std::vector<Guide>{lie}}) {
    const GuidedImage image = estimate_guided(counts, guides);
    row.insert(row.end(), {off(image.mean), percent(image.error)});
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Yields that change from place to place by 30 %, 64 electrons per pixel";
  const io::PlotAxis x{"correlation length (pixels)", true, {}};
  out.panels = {panel(t, "error", x, {"rms error over the mean (%)", false, {}},
                      {{"guided_percent", "neighbours alone"},
                       {"right_percent", "a guide that is right"},
                       {"lie_percent", "a guide that lies"},
                       {"plain_percent", "plain"}}),
                panel(t, "and what is stated", x, {"stated error over the mean (%)", false, {}},
                      {{"guided_stated_percent", "neighbours alone"},
                       {"right_stated_percent", "a guide that is right"},
                       {"lie_stated_percent", "a guide that lies"}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep guided_detail() {
  return {"guided_detail",
          "guided images of detail from 16 pixels down to a third of one",
          {"correlation_px", "plain_percent", "guided_percent", "guided_stated_percent",
           "right_percent", "right_stated_percent", "lie_percent", "lie_stated_percent"},
          {16, 8, 4, 2, 1.4, 1, 0.7, 0.5, 0.3},
          at,
          1,
          1e-4,
          plot};
}

}  // namespace surf::limits
