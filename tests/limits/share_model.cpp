// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale/share_model.h"

#include <gtest/gtest.h>

namespace surf::scale {
namespace {

UnitCosts long_units() {
  UnitCosts costs;
  costs.durations_s = {0.05, 0.1, 0.15};
  costs.merge_s = costs.unpack_s = costs.pack_s = 1e-6;
  costs.bytes = 500;
  return costs;
}

Messages quick() {
  Messages m;
  m.leader_s = m.follower_s = m.latency_s = 1e-6;
  return m;
}

TEST(ShareModel, FewRanksLoseNothingButTheEnd) {
  const Sharing s = simulate_sharing(long_units(), quick(), {4, 4}, 16000);
  EXPECT_GT(s.efficiency, 0.995);
  EXPECT_LE(s.efficiency, 1);
  EXPECT_LT(s.leader_busy, 0.01);
  EXPECT_NEAR(s.efficiency, bound_sharing(long_units(), quick(), {4, 4}, 16000).efficiency, 0.005);
}

TEST(ShareModel, TheLeaderBoundsWhatManyRanksGain) {
  UnitCosts costs = long_units();
  costs.merge_s = 1e-3;  // a hundred threads' worth
  const Messages m = quick();
  const Sharing few = simulate_sharing(costs, m, {400, 1}, 40000),
                many = simulate_sharing(costs, m, {800, 1}, 40000);
  EXPECT_GT(few.leader_busy, 0.95);
  EXPECT_NEAR(many.seconds / few.seconds, 1, 0.02);
  EXPECT_NEAR(few.seconds / bound_sharing(costs, m, {400, 1}, 40000).seconds, 1, 0.05);
  EXPECT_GT(many.waiting_s_per_unit, few.waiting_s_per_unit);
}

TEST(ShareModel, LongJobsAreToldFromShorterOnes) {
  const double all = simulate_sharing(long_units(), quick(), {8, 2}, 60000).seconds;
  EXPECT_NEAR(simulate_sharing(long_units(), quick(), {8, 2}, 60000, 6000).seconds / all, 1, 0.02);
}

}  // namespace
}  // namespace surf::scale
