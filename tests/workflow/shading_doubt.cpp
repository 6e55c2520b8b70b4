// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading_doubt.h"

#include <gtest/gtest.h>

#include <array>
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
  // A fit that was pulled away from what a scan told, and is no surer for it.
  const Measured pulled = doubted({98.3, 0.53}, {100, 0.5}, 5);
  EXPECT_EQ(pulled.value, 100);
  EXPECT_EQ(pulled.standard_error, 0.5);
}

TEST(ShadingDoubt, ImagesTellHeightsInTheirOwnWays) {
  const double from_above = height_doubt_nm({FeatureKind::line, 100, 0});
  EXPECT_EQ(from_above, 20);
  EXPECT_EQ(height_doubt_nm({FeatureKind::hole, 50}), 10);
  EXPECT_NEAR(height_doubt_nm({FeatureKind::hole, 50, 12}), 2, 1e-9);
  // A flank runs farther in the image the more the beam is tilted.
  const double little = height_doubt_nm({FeatureKind::line, 100, 3}),
               more = height_doubt_nm({FeatureKind::line, 100, 8});
  EXPECT_NEAR(little, 5, 0.1);
  EXPECT_NEAR(more, 1.9, 0.1);
  // The image from above still tells what it tells alone.
  EXPECT_EQ(height_doubt_nm({FeatureKind::line, 100, 0.1}), from_above);
  EXPECT_EQ(height_doubt_nm({FeatureKind::line, 20, 3}), 4);
}

TEST(ShadingDoubt, AWallThatIsHigherRunsAsFar) {
  const std::array<Measured, profile_numbers> fitted{{{70, 1}, {80, 8}, {84, 0.6}, {3, 2}, {3, 2}}};
  const auto out = doubted_height(fitted, {100, 20}, 20);
  const auto flank = [](const auto& wall) {
    return wall[profile_height].value / std::tan(wall[profile_angle].value * std::acos(-1) / 180);
  };
  EXPECT_GT(out[profile_height].value, 85);
  EXPECT_LT(out[profile_height].value, 95);
  EXPECT_GT(out[profile_height].standard_error, 13);
  EXPECT_LT(out[profile_height].standard_error, 20);
  EXPECT_NEAR(flank(out), flank(fitted), 1e-9);
  EXPECT_GT(out[profile_angle].standard_error, 0.8);
  EXPECT_EQ(out[profile_width].value, 70);
  // A height that is held, and corners for which no other wall is there.
  EXPECT_EQ(doubted_height(fitted, {80, 0}, 16)[profile_height].standard_error, 8);
  auto round = fitted;
  round[profile_height].value = 130;
  round[profile_top].value = round[profile_foot].value = 68;
  const auto kept = doubted_height(round, {60, 20}, 12);
  EXPECT_EQ(kept[profile_height].value, 130);
  EXPECT_GT(kept[profile_height].standard_error, 9);
}

}  // namespace
}  // namespace surf::workflow
