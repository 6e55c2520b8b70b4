// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/round_tip_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/morphology.h"
#include "surf/afm/substrate_noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

constexpr AfmNoise noise{0.5, 0.02};

HeightField with_noise(HeightField field) {
  const Grid<double> e = simulate_noise(noise, field.z_nm.width(), field.z_nm.height(), 3);
  for (std::size_t i = 0; i < e.size(); ++i) field.z_nm.data()[i] += e.data()[i];
  return field;
}

TEST(RoundTipSearch, BoundsATipOnPillarsFromOutside) {
  HeightField pillars{{5, 5}, Grid<double>(90, 80)};
  for (int y = 10; y < 75; y += 22)
    for (int x = 12; x < 85; x += 26)
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) pillars.z_nm(x + i, y + j) = 60;
  const Tip truth = conical_tip(20, 0.35, {5, 5, 15, 15});
  const RoundTip found = find_round_tip(with_noise(dilate(pillars, truth)), {.noise = noise});
  EXPECT_TRUE(found.summary.bounded);
  EXPECT_GE(found.summary.widest, 9);
  EXPECT_GT(found.summary.threshold_nm, 0);
  const Tip& tip = found.tip;
  for (int k = 1; k <= 3; ++k) {
    const double there = tip.z_nm(tip.apex_x + k, tip.apex_y);
    EXPECT_GT(there, truth.z_nm(truth.apex_x + k, truth.apex_y) - 3) << k;
    EXPECT_LT(there, 0.1 * truth.z_nm(truth.apex_x + k, truth.apex_y)) << k;
  }
}

TEST(RoundTipSearch, TakesATipThatNothingBoundsAsSharp) {
  HeightField hill{{5, 5}, Grid<double>(60, 50)};
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) hill.z_nm(x, y) = 0.05 * x;
  const RoundTip found = find_round_tip(with_noise(hill), {.noise = noise});
  EXPECT_FALSE(found.summary.bounded);
  EXPECT_EQ(found.tip.z_nm.size(), 1u);
}

TEST(RoundTipSearch, RefusesScansThatTellNothing) {
  const HeightField flat{{5, 5}, Grid<double>(40, 40)};
  EXPECT_THROW(find_round_tip(with_noise(flat), {.noise = {0.5, 0.2}}), InvalidInput);
  HeightField small{{5, 5}, Grid<double>(4, 4)};
  small.z_nm(1, 1) = 50;
  EXPECT_THROW(find_round_tip(small, {.noise = noise}), InvalidInput);
  CancelToken cancel;
  cancel.cancel();
  HeightField step{{5, 5}, Grid<double>(40, 40)};
  step.z_nm(20, 20) = 50;
  EXPECT_THROW(find_round_tip(step, {.noise = noise, .watch = {{}, &cancel}}), Interrupted);
}

TEST(SubstrateNoise, TellsRoughGroundFromNoise) {
  const HeightField plane{{5, 5}, Grid<double>(90, 80)};
  EXPECT_FALSE(is_rough_ground(estimate_substrate_noise(with_noise(plane))));
  EXPECT_TRUE(is_rough_ground(estimate_substrate_noise(make_rough({450, 400, 5}, 2, 40, 1))));
}

}  // namespace
}  // namespace surf
