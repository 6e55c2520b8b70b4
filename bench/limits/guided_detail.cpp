// SPDX-License-Identifier: GPL-3.0-or-later
// Guided images of yields that change ever faster, without a guide, with one that is right but for
// a factor, and with one that lies.
#include <cmath>

#include "guided_counts.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int primaries = 64;
constexpr double mean_yield = 0.5;

std::vector<double> at(double correlation_px) {
  Grid<double> yields = random_pattern(correlation_px, 1);
  for (double& value : yields.data()) value = mean_yield * std::exp(0.3 * value - 0.045);
  const CountImage counts = poisson_counts(yields, primaries, 11);
  Guide right{"right", yields, true}, lie{"lie", random_pattern(correlation_px, 2), true};
  for (double& value : right.values.data()) value = 0.1 + 0.7 * value;
  const Grid<double> zero(yields.width(), yields.height(), 0.0);
  std::vector<double> row{rms_percent(plain_mean(counts, primaries), yields, mean_yield)};
  for (const std::vector<Guide>& guides :
       {std::vector<Guide>{}, std::vector<Guide>{right}, std::vector<Guide>{lie}}) {
    const GuidedImage image = estimate_guided(counts, guides);
    row.insert(row.end(), {rms_percent(image.mean, yields, mean_yield),
                           rms_percent(image.error, zero, mean_yield)});
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
