// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/tip_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "surf/afm/round_tip.h"
#include "surf/afm/tip_shapes.h"

namespace surf::reconstruction {
namespace {

Tip cone() { return conical_tip(50, 0.5, {10, 12, 21, 19}); }

TEST(TipFamily, NoChangeIsTheSameTip) {
  const Tip tip = cone();
  const TipFamily family(tip);
  std::vector<TipChange> unused;
  EXPECT_EQ(family.changed(tip, {}).z_nm, tip.z_nm);
  EXPECT_EQ(family.changed(tip, {}, &unused).z_nm, tip.z_nm);
}

TEST(TipFamily, AFactorForAllSlopesIsOneForAllHeights) {
  const Tip tip = cone();
  TipChange all{};
  for (int place = 0; place < tip_places; ++place) all[place * tip_waves] = std::log(1.25);
  const Tip changed = TipFamily(tip).changed(tip, all);
  for (std::size_t i = 0; i < tip.z_nm.size(); ++i)
    ASSERT_NEAR(changed.z_nm.data()[i], 1.25 * tip.z_nm.data()[i], 1e-9);
}

TEST(TipFamily, AnyChangeIsATipThatFallsOutwards) {
  const Tip tip = cone();
  const TipFamily family(tip);
  for (int k = 0; k < tip_numbers; ++k)
    for (const double by : {-2.0, 2.0}) {
      TipChange change{};
      change[k] = by;
      const Tip changed = family.changed(tip, change);
      EXPECT_NO_THROW(validate(changed));
      for (int x = tip.apex_x; x + 1 < tip.z_nm.width(); ++x)
        EXPECT_LT(changed.z_nm(x + 1, tip.apex_y), changed.z_nm(x, tip.apex_y)) << k << " " << x;
    }
}

TEST(TipFamily, NumbersCountFromTheApexOutwards) {
  const Tip tip = cone();
  const TipFamily family(tip);
  TipChange inner{}, outer{};
  inner.front() = outer[(tip_places - 1) * tip_waves] = 0.5;
  const int x = tip.apex_x + 1, rim = tip.z_nm.width() - 1, y = tip.apex_y;
  EXPECT_LT(family.changed(tip, inner).z_nm(x, y), 1.1 * tip.z_nm(x, y));
  EXPECT_NEAR(family.changed(tip, inner).z_nm(rim, y) / tip.z_nm(rim, y), 1, 0.02);
  EXPECT_EQ(family.changed(tip, outer).z_nm(x, y), tip.z_nm(x, y));
  EXPECT_LT(family.changed(tip, outer).z_nm(rim, y), 1.03 * tip.z_nm(rim, y));
}

TEST(TipFamily, WavesLeanAndWiden) {
  const Tip tip = conical_tip(50, 0.5, {10, 10, 21, 21});
  const TipFamily family(tip);
  TipChange lean{}, wide{}, aslant{};
  for (int place = 0; place < tip_places; ++place)
    lean[place * tip_waves + 1] = wide[place * tip_waves + 3] = aslant[place * tip_waves + 4] = 0.4;
  const Tip leaning = family.changed(tip, lean), widened = family.changed(tip, wide),
            slanted = family.changed(tip, aslant);
  const int a = tip.apex_x;
  const auto factor = [&](const Tip& t, int x, int y) {
    return t.z_nm(a + x, a + y) / tip.z_nm(a + x, a + y);
  };
  EXPECT_NEAR(factor(leaning, 6, 0), std::exp(0.4), 1e-9);
  EXPECT_NEAR(factor(leaning, -6, 0), std::exp(-0.4), 1e-9);
  EXPECT_NEAR(factor(leaning, 0, 6), 1, 1e-9);
  EXPECT_NEAR(factor(widened, 6, 0), std::exp(0.4 * second_wave), 1e-9);
  EXPECT_NEAR(factor(widened, -6, 0), std::exp(0.4 * second_wave), 1e-9);
  EXPECT_NEAR(factor(widened, 0, 6), std::exp(-0.4 * second_wave), 1e-9);
  EXPECT_NEAR(factor(slanted, 4, 4), std::exp(0.4 * second_wave), 1e-9);
  EXPECT_NEAR(factor(slanted, 4, -4), std::exp(-0.4 * second_wave), 1e-9);
}

TEST(TipFamily, DerivativesAreThoseOfCentralDifferences) {
  const Tip tip = cone();
  const TipFamily family(tip);
  TipChange at;
  for (int k = 0; k < tip_numbers; ++k) at[k] = 0.3 * std::sin(1.7 * k);
  std::vector<TipChange> by_change;
  family.changed(tip, at, &by_change);
  ASSERT_EQ(by_change.size(), tip.z_nm.size());
  constexpr double step = 1e-5;
  for (int k = 0; k < tip_numbers; ++k) {
    TipChange up = at, down = at;
    up[k] += step, down[k] -= step;
    const Tip a = family.changed(tip, up), b = family.changed(tip, down);
    for (std::size_t i = 0; i < tip.z_nm.size(); ++i)
      ASSERT_NEAR(by_change[i][k], (a.z_nm.data()[i] - b.z_nm.data()[i]) / (2 * step), 1e-6);
  }
}

TEST(TipFamily, IsTheSameOnCoarserSamples) {
  const Tip fine = conical_tip(50, 0.5, {5, 5, 61, 61}),
            coarse = conical_tip(50, 0.5, {20, 20, 15, 15});
  const TipFamily family(fine);
  const TipChange change{0.3, -0.2, 0.1, 0.4, -0.5, 0.2, -0.1};
  const Tip a = family.changed(fine, change), b = family.changed(coarse, change);
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 15; ++x)
      ASSERT_NEAR(b.z_nm(x, y), a.z_nm(30 + 4 * (x - 7), 30 + 4 * (y - 7)), 1e-9);
}

TEST(TipFamily, SamplesThatTheTipDoesNotHaveAndFlatEndsStay) {
  Tip tip = cone();
  tip.z_nm(0, 0) = -std::numeric_limits<double>::infinity();
  for (int y = tip.apex_y - 2; y <= tip.apex_y + 2; ++y)
    for (int x = tip.apex_x - 2; x <= tip.apex_x + 2; ++x) tip.z_nm(x, y) = 0;
  TipChange change;
  change.fill(0.7);
  const Tip changed = TipFamily(tip).changed(tip, change);
  EXPECT_NO_THROW(validate(changed));
  EXPECT_TRUE(std::isinf(changed.z_nm(0, 0)));
  EXPECT_EQ(changed.z_nm(tip.apex_x + 2, tip.apex_y), 0);
  EXPECT_LT(changed.z_nm(0, tip.apex_y), tip.z_nm(0, tip.apex_y));
}

TEST(TipFamily, WithoutASlopeNothingCanChange) {
  const Tip point{{5, 5}, Grid<double>(1, 1), 0, 0}, flat{{5, 5}, Grid<double>(5, 5), 2, 2};
  for (const Tip& tip : {point, flat}) {
    const TipFamily family(tip);
    EXPECT_FALSE(family.can_change());
    TipChange change;
    change.fill(1);
    EXPECT_EQ(family.changed(tip, change).z_nm, tip.z_nm);
  }
  EXPECT_TRUE(TipFamily(cone()).can_change());
}

}  // namespace
}  // namespace surf::reconstruction
