// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/round_tip.h"

#include <gmock/gmock.h>

#include <cmath>

#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double pitch = 10;

/// A cone as a scan of lines along x tells it: flat along them.
Tip told_across(const Tip& cone) {
  Tip t = cone;
  for (int j = 0; j < t.z_nm.height(); ++j)
    for (int i = 0; i < t.z_nm.width(); ++i) t.z_nm(i, j) = cone.z_nm(cone.apex_x, j);
  return t;
}

TEST(RoundTip, WhatIsToldAcrossLinesHoldsAllAround) {
  const Tip cone = conical_tip(40, 0.4, {pitch, pitch, 13, 13});
  const Tip made = tip_below({round_profile_nm(told_across(cone), 0)}, pitch, pitch, 1, 6);
  const Tip whole = tip_below({round_profile_nm(told_across(cone), 0)}, pitch, pitch, 1e6, 9);
  EXPECT_LT(made.z_nm.width(), whole.z_nm.width());  // no wider than it has to be
  ASSERT_GE(whole.apex_x, 6);
  for (int j = 0; j < 13; ++j)
    for (int i = 0; i < 13; ++i)
      EXPECT_NEAR(whole.z_nm(i + whole.apex_x - 6, j + whole.apex_y - 6), cone.z_nm(i, j), 2.5)
          << i << " " << j;
  EXPECT_EQ(whole.z_nm(whole.apex_x, whole.apex_y), 0);
}

TEST(RoundTip, CornersTellWhereAllElseIsFlat) {
  Tip square{{pitch, pitch}, Grid<double>(9, 9), 4, 4};
  for (const int j : {0, 8})
    for (const int i : {0, 8}) square.z_nm(i, j) = -40;
  EXPECT_EQ(round_profile_nm(square, 0.05)[4], 0);
  EXPECT_LT(round_profile_nm(square, 0.05).back(), -5);
}

TEST(RoundTip, GoesOnAsSteeplyWhereNothingIsTold) {
  const Tip cone = conical_tip(20, 0.5, {pitch, pitch, 7, 7}),
            wide = conical_tip(20, 0.5, {pitch, pitch, 21, 21});
  const Tip made = tip_below({round_profile_nm(cone, 0.5)}, pitch, pitch, -wide.z_nm(20, 10), 50);
  ASSERT_GE(made.apex_x, 10);
  for (int r = 0; r <= 10; ++r)
    EXPECT_NEAR(made.z_nm(made.apex_x + r, made.apex_y), wide.z_nm(10 + r, 10),
                4);  // corners are interpolated
}

TEST(RoundTip, IsBelowEveryBound) {
  const Tip made = tip_below({{0, -3, -9}, {0, -1, -10, -12}}, pitch, 2 * pitch, 15, 9);
  std::vector<double> row;
  for (int x = made.apex_x; x < made.z_nm.width(); ++x) row.push_back(made.z_nm(x, made.apex_y));
  EXPECT_THAT(row, Pointwise(DoubleNear(1e-9), {0.0, -3.0, -10.0, -17.0}));
  EXPECT_EQ(made.apex_y, 1);
  EXPECT_DOUBLE_EQ(made.z_nm(made.apex_x, 2), -10);
}

TEST(RoundTip, MissingSamplesAndPoorTipsDoNoHarm) {
  const auto ball = round_profile_nm(ball_tip(30, 10, 0, {pitch, pitch, 9, 9}), 0.1);
  EXPECT_TRUE(std::ranges::none_of(ball, [](double z) { return std::isnan(z) || z > 0; }));
  EXPECT_THAT(round_profile_nm({{pitch, pitch}, Grid<double>(1, 1), 0, 0}, 0.1), ElementsAre(0));
  EXPECT_EQ(tip_below({{0}}, pitch, pitch, 10, 5).z_nm(2, 2), 0);
  EXPECT_THROW(round_profile_nm(conical_tip(5, 0.4, {1, 1, 5, 5}), 1.5), UsageError);
  EXPECT_THROW(tip_below({{1, 0}}, pitch, pitch, 10, 5), UsageError);
}

}  // namespace
}  // namespace surf
