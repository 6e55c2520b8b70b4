// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_doubt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "surf/afm/tip_shapes.h"

namespace surf {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

Tip parabola(double radius_nm, int size = 21) {
  TipSampling sampling;
  sampling.width = sampling.height = size;
  return parabolic_tip(radius_nm, sampling);
}

TipSweep sweep_of(std::size_t chosen, const Tip& tip) {
  TipSweep sweep;
  for (int i = 1; i <= 5; ++i) {
    SweptTip swept;
    swept.threshold_nm = i;
    swept.residual_nm = swept.peaks_nm = 7;
    swept.expected_nm = swept.expected_peaks_nm = 1;
    swept.tip = tip;
    sweep.curve.push_back(swept);
  }
  sweep.chosen = chosen;
  return sweep;
}

TEST(TipDoubt, IsNoneOfAnOrdinaryTip) {
  EXPECT_THAT(doubt_of_tip(sweep_of(3, parabola(10))), IsEmpty());
  EXPECT_THAT(doubt_of_shape(parabola(2000)), IsEmpty());  // blunt, but a tip: 95 widths
  EXPECT_THAT(doubt_of_shape(parabola(10, 1)), IsEmpty());
}

TEST(TipDoubt, IsOfTheEndOfASweepAndOfWhatExplainsNothing) {
  TipSweep sweep = sweep_of(4, parabola(10));
  EXPECT_EQ(doubt_of_tip(sweep),
            "its threshold of 5.00 nm is the largest that was tried, so that none is told");
  sweep.chosen = 1;
  sweep.verdict = TipSweepVerdict::none;
  EXPECT_EQ(doubt_of_tip(sweep),
            "no tip explains the scan: 7.0 times what the noise leaves is left at best");
}

TEST(TipDoubt, IsOfAFlatTip) {
  Tip flat = parabola(10);
  flat.z_nm = Grid<double>(21, 21, 0.0);
  EXPECT_THAT(doubt_of_shape(flat), HasSubstr("flat"));
  Tip blunted = parabola(10);  // by a threshold of 2 nm
  for (double& z : blunted.z_nm.data()) z = std::min(0.0, z + 2);
  EXPECT_THAT(doubt_of_shape(blunted), IsEmpty());
  EXPECT_THAT(doubt_of_shape(parabola(3000)),
              HasSubstr("its radius of 3.00 um is that of a plane over its width of 21.0 nm"));
  EXPECT_THAT(doubt_of_tip(sweep_of(4, flat)),
              AllOf(HasSubstr("largest that was tried"), HasSubstr("; it is flat")));
}

TEST(TipDoubt, IsOfNoiseThatTakesTheWholeRoughness) {
  HeightField scan;
  scan.z_nm = Grid<double>(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      scan.z_nm(x, y) = 3 * std::sin(0.3 * x) + 2 * x;  // Sq 2.04 nm about its plane
  const auto noise = [](double sigma) { return AfmNoise{0, sigma * sigma}; };
  EXPECT_THAT(doubt_of_noise(noise(1), scan), IsEmpty());
  EXPECT_THAT(
      doubt_of_noise(noise(2), scan),
      AllOf(HasSubstr("the noise of 2.00 nm, from differences of"), HasSubstr("Sq 2.04 nm")));
}

}  // namespace
}  // namespace surf
