// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/best_tip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "twin_experiment.h"

namespace surf {
namespace {

using test::twin_experiment;
using test::TwinExperiment;

constexpr double sigma_nm = 0.3;

AfmNoise noise_of(double alpha) { return {alpha, (1 - alpha * alpha) * sigma_nm * sigma_nm}; }

double error_of_estimate(double alpha, double apart_nm, std::uint64_t seed) {
  const TwinExperiment twin = twin_experiment(noise_of(alpha), apart_nm, seed);
  BestTipOptions options;
  options.width = options.height = twin.tip.z_nm.width();
  options.noise = noise_of(alpha);
  const auto [tip, summary] = best_tip(twin.scans, options);
  return twin.error_of(tip);
}

// Root mean square over several experiments. The classical algorithm is off by 2 nm and more.
double error_over(int seeds, double alpha, double apart_nm) {
  double squares = 0;
  for (int seed = 1; seed <= seeds; ++seed)
    squares +=
        std::pow(error_of_estimate(alpha, apart_nm, static_cast<std::uint64_t>(seed)), 2) / seeds;
  return std::sqrt(squares);
}

TEST(BestTip, IsWithinTheNoiseOfTheTrueOne) { EXPECT_LE(error_over(3, 0, 0), 0.3); }
TEST(BestTip, IsWithinCorrelatedNoiseToo) { EXPECT_LE(error_over(3, 0.6, 0), 0.3); }
TEST(BestTip, FindsADoubleTip) { EXPECT_LE(error_over(6, 0, 4.5), 0.3); }

TEST(BestTip, IsTheSameForAnyThreadsAndStops) {
  const TwinExperiment twin = twin_experiment(noise_of(0), 0, 1, 4);
  BestTipOptions options;
  options.width = options.height = twin.tip.z_nm.width();
  options.noise = noise_of(0);
  options.threads = 1;
  const auto [one, summary] = best_tip(twin.scans, options);
  EXPECT_GT(summary.touched, 0);
  options.threads = 3;
  EXPECT_TRUE(best_tip(twin.scans, options).tip.z_nm == one.z_nm);
  options.noise.alpha = 1;
  EXPECT_THROW(best_tip(twin.scans, options), InvalidInput);
  CancelToken cancel;
  cancel.cancel();
  options.noise.alpha = 0;
  options.watch.cancel = &cancel;
  EXPECT_THROW(best_tip(twin.scans, options), Interrupted);
}

}  // namespace
}  // namespace surf
