// SPDX-License-Identifier: GPL-3.0-or-later
// Guided images of a detector that sees ever fewer electrons, most of them in few places, as one of
// a narrow cone does.
#include <cmath>

#include "guided_counts.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int primaries = 64;

std::vector<double> at(double counts_per_pixel) {
  // Lognormal: half the pixels give a seventh of the mean or less, one in a hundred ten times it.
  constexpr double deviation = 2;
  Grid<double> yields = random_pattern(3, 1);
  for (double& value : yields.data())
    value = counts_per_pixel / primaries * std::exp(deviation * value - deviation * deviation / 2);
  const double mean = counts_per_pixel / primaries;
  double plain = 0, guided = 0, stated = 0, within = 0;
  constexpr int seeds = 4;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const CountImage counts = poisson_counts(yields, primaries, seed);
    const GuidedImage image = estimate_guided(counts, {});
    plain += std::pow(rms_percent(plain_mean(counts, primaries), yields, mean), 2) / seeds;
    guided += std::pow(rms_percent(image.mean, yields, mean), 2) / seeds;
    for (std::size_t i = 0; i < yields.size(); ++i) {
      const double error = image.error.data()[i];
      stated += std::pow(100 * error / mean, 2) / static_cast<double>(seeds * yields.size());
      within += 100.0 * (std::abs(image.mean.data()[i] - yields.data()[i]) <= 2 * error) /
                static_cast<double>(seeds * yields.size());
    }
  }
  return {std::sqrt(plain), std::sqrt(guided), std::sqrt(stated), within};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A detector that sees few of 64 electrons per pixel, most of them in few places";
  const io::PlotAxis x{"counts per pixel", true, {}};
  out.panels = {panel(t, "error", x, {"rms error over the mean (%)", true, {}},
                      {{"plain_percent", "plain"},
                       {"guided_percent", "guided"},
                       {"guided_stated_percent", "guided, as stated", true}}),
                panel(t, "intervals", x, {"pixels within two stated errors (%)", false, {}},
                      {{"within_two_percent", "guided"}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep guided_sparse() {
  return {"guided_sparse",
          "guided images by ever fewer counts per pixel, of yields that differ by far",
          {"counts_per_pixel", "plain_percent", "guided_percent", "guided_stated_percent",
           "within_two_percent"},
          {30, 10, 3, 1, 0.3, 0.1, 0.03, 0.01},
          at,
          0.03,
          1e-4,
          plot};
}

}  // namespace surf::limits
