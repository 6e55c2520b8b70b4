// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surf::workflow {
namespace {

TEST(ShadingDoubt, AddsToWhatTheDataTold) {
  constexpr double none = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(doubted_error(3, none, 4), 5, 1e-12);
  // Data of 6, a prior of 20, a doubt of 8: data of 10.
  const auto both = [](double a, double b) { return 1 / std::hypot(1 / a, 1 / b); };
  EXPECT_NEAR(doubted_error(both(6, 20), 20, 8), both(10, 20), 1e-12);
}

TEST(ShadingDoubt, LeavesWhatTheDataDidNotTell) {
  EXPECT_EQ(doubted_error(0, 0, 10), 0);     // held
  EXPECT_EQ(doubted_error(20, 20, 10), 20);  // the prior's alone
  EXPECT_LT(doubted_error(0.5, 0.51, 10), 0.51);
}

}  // namespace
}  // namespace surf::workflow
