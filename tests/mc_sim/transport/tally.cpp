// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/tally.h"

#include "statistics.h"
#include "surf/core/random.h"

namespace surf::mc {

TEST(Estimate, ComesFromTheScatterOfPrimaries) {
  // 0, 1, 1, 4: mean 1.5, variance of the mean (18/4 - 2.25) / 3.
  const Estimate e = estimate(4, {6, 18});
  EXPECT_DOUBLE_EQ(e.mean, 1.5);
  EXPECT_DOUBLE_EQ(e.standard_error, std::sqrt((4.5 - 2.25) / 3));
}

TEST(Estimate, HasLimits) {
  EXPECT_EQ(estimate(0, {}).mean, 0);
  EXPECT_EQ(estimate(1, {3, 9}).mean, 3);
  EXPECT_EQ(estimate(1, {3, 9}).standard_error, 0);
  EXPECT_EQ(estimate(10, {20, 40}).standard_error, 0);
}

TEST(EnergySum, DoesNotDependOnOrder) {
  RandomStream random(1, 0, 0);
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(1e4 * (random.uniform() - 0.3));
  EnergySum forward, backward;
  double exact = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    forward.add(values[i]);
    backward.add(values[values.size() - 1 - i]);
    exact += values[i];
  }
  EXPECT_EQ(forward.ev(), backward.ev());
  EXPECT_NEAR(forward.ev(), exact, 1000 * 0x1p-17);
}

TEST(LossCause, HasNames) {
  for (int c = 0; c < loss_causes; ++c) EXPECT_STRNE(name(static_cast<LossCause>(c)), "unknown");
}

}  // namespace surf::mc
