// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/best_tip.h"

#include <gtest/gtest.h>

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
  BestTipSummary summary;
  const Tip tip = best_tip(twin.scans, options, summary);
  return twin.error_of(tip);
}

TEST(BestTip, IsWithinTheNoiseOfTheTrueOne) {
  for (const std::uint64_t seed : {1, 2, 3}) EXPECT_LE(error_of_estimate(0, 0, seed), 0.3) << seed;
}

TEST(BestTip, IsWithinCorrelatedNoiseToo) {
  for (const std::uint64_t seed : {1, 2}) EXPECT_LE(error_of_estimate(0.6, 0, seed), 0.3) << seed;
}

TEST(BestTip, FindsADoubleTip) {
  for (const std::uint64_t seed : {1, 2}) EXPECT_LE(error_of_estimate(0, 4.5, seed), 0.3) << seed;
}

}  // namespace
}  // namespace surf
