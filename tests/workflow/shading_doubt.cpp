// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surf::workflow {
namespace {

/// Two measurements of one number, weighted.
Measured both(const Measured& a, const Measured& b) {
  const double wa = std::pow(a.standard_error, -2), wb = std::pow(b.standard_error, -2);
  return {(wa * a.value + wb * b.value) / (wa + wb), 1 / std::sqrt(wa + wb)};
}

TEST(ShadingDoubt, MakesWhatTheDataToldCountLess) {
  const Measured alone = doubted({70, 3}, {0, std::numeric_limits<double>::infinity()}, 4);
  EXPECT_NEAR(alone.value, 70, 1e-12);
  EXPECT_NEAR(alone.standard_error, 5, 1e-12);
  // Data of 6, a doubt of 8: data of 10.
  const Measured prior{100, 20}, less = doubted(both({70, 6}, prior), {100, 20}, 8),
                                 wanted = both({70, 10}, prior);
  EXPECT_NEAR(less.value, wanted.value, 1e-9);
  EXPECT_NEAR(less.standard_error, wanted.standard_error, 1e-9);
}

TEST(ShadingDoubt, LeavesWhatTheDataDidNotTell) {
  EXPECT_EQ(doubted({30, 0}, {30, 0}, 10).standard_error, 0);  // held
  const Measured prior_alone = doubted({30, 20}, {30, 20}, 10);
  EXPECT_EQ(prior_alone.value, 30);
  EXPECT_EQ(prior_alone.standard_error, 20);
  EXPECT_LT(doubted({30, 0.5}, {30, 0.51}, 10).standard_error, 0.51);
}

}  // namespace
}  // namespace surf::workflow
