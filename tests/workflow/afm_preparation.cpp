// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/afm_preparation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf::workflow {
namespace {

constexpr double pitch = 5;

/// Blocks on a tilted plane, by a dull tip, with noise.
HeightField scan(double radius_nm) {
  HeightField field = make_mesa({495, 395, pitch}, 60, 120, 15);
  const HeightField other = make_mesa({495, 395, pitch}, 60, 60, 15);
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width() - 35; ++x)
      field.z_nm(x, y) = std::max(field.z_nm(x, y), other.z_nm(x + 35, y));
  field = dilate(field, conical_tip(radius_nm, 0.35, {pitch, pitch, 25, 25}));
  const Grid<double> noise =
      simulate_noise({0.6, 0.02}, field.z_nm.width(), field.z_nm.height(), 2);
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      field.z_nm(x, y) += noise(x, y) + 0.01 * field.x_nm(x) + 300;
  return field;
}

TEST(AfmPreparation, FindsLevelNoiseAndTip) {
  const PreparedAfm p = prepare_afm(scan(30));
  EXPECT_NEAR(p.tilt_deg, std::atan(0.01) * 180 / 3.14159265, 0.01);
  EXPECT_NEAR(p.noise.alpha, 0.6, 0.05);
  EXPECT_NEAR(p.noise.innovation_nm2, 0.02, 0.004);
  EXPECT_FALSE(p.tip_given);
  EXPECT_NEAR(p.eroded().z_nm(5, 5), 0, 1.5);
}

TEST(AfmPreparation, TakesWhatIsGiven) {
  AfmPreparationOptions o;
  o.level.method = LevelMethod::none;
  o.noise = AfmNoise{0.1, 0.3};
  o.tip = conical_tip(30, 0.35, {2 * pitch, 2 * pitch, 9, 9});
  const HeightField as_read = scan(30);
  const PreparedAfm p = prepare_afm(as_read, o);
  EXPECT_EQ(p.image.z_nm, as_read.z_nm);
  EXPECT_EQ(p.noise.innovation_nm2, 0.3);
  EXPECT_TRUE(p.tip_given);
  EXPECT_EQ(p.tip.z_nm.width(), 17);  // at the scan's pitch
  EXPECT_EQ(p.tip.pitch_x_nm, pitch);
}

/// Two narrow walls that cross, which tell their tip.
HeightField walls(double radius_nm) {
  HeightField f{{pitch, pitch}, Grid<double>(70, 60)};
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 70; ++x)
      f.z_nm(x, y) = std::abs(x - 25) < 2 || std::abs(y - 35) < 2 ? 40 : 0;
  f = dilate(f, conical_tip(radius_nm, 0.35, {pitch, pitch, 25, 25}));
  const Grid<double> noise = simulate_noise({0.6, 0.02}, 70, 60, 4);
  for (std::size_t i = 0; i < noise.size(); ++i) f.z_nm.data()[i] += noise.data()[i];
  return f;
}

TEST(AfmPreparation, TipsAreRoundUnlessASizeIsSaid) {
  const HeightField seen = walls(30);
  const PreparedAfm p = prepare_afm(seen);
  EXPECT_TRUE(p.tip_round);
  const Tip truth = conical_tip(30, 0.35, {pitch, pitch, 13, 13});
  for (int r = 1; r <= 3 && p.tip.apex_x + r < p.tip.z_nm.width(); ++r) {
    EXPECT_LT(p.tip.z_nm(p.tip.apex_x + r, p.tip.apex_y), 0) << r;
    EXPECT_GT(p.tip.z_nm(p.tip.apex_x + r, p.tip.apex_y), truth.z_nm(8 + r, 6))
        << r;  // narrower by less than two samples
  }
  EXPECT_LE(std::ranges::min(p.tip.z_nm.data()), -35);  // down the relief
  EXPECT_GT(p.image.z_nm(30, 15) - p.eroded().z_nm(30, 15),
            2);  // beside a wall the tip's flank is gone
  AfmPreparationOptions free;
  free.tip_size = 9;
  EXPECT_EQ(prepare_afm(seen, free).tip.z_nm.width(), 9);
}

TEST(AfmPreparation, TakesAScanWithoutNoiseWhereItsNoiseIsGiven) {
  HeightField clean{{pitch, pitch}, Grid<double>(60, 60)};
  for (int y = 20; y < 45; ++y)
    for (int x = 15; x < 40; ++x) clean.z_nm(x, y) = 40;
  EXPECT_THROW(prepare_afm(clean), InvalidInput);
  AfmPreparationOptions o;
  o.noise = AfmNoise{0.5, 0.09};
  const PreparedAfm p = prepare_afm(clean, o);
  EXPECT_EQ(p.noise.alpha, 0.5);
  EXPECT_FALSE(p.rough_ground);
}

TEST(AfmPreparation, AScanThatTellsNothingOfItsTipIsTheSurface) {
  const PreparedAfm p = prepare_afm(scan(5));  // corners square to the pixel bound no tip
  EXPECT_EQ(p.tip.z_nm.width(), 1);
  EXPECT_THAT(p.tip_warnings, testing::Contains(testing::HasSubstr("taken as sharp")));
}

TEST(AfmPreparation, DoubtsATipThatTheScanDoesNotTell) {
  AfmPreparationOptions o;
  o.tip_size = 9;
  const PreparedAfm told = prepare_afm(walls(30), o);
  EXPECT_EQ(told.tip.doubt, "");
  o.noise = AfmNoise{0, 400};  // 20 nm of noise hide walls of 40 nm
  const PreparedAfm p = prepare_afm(walls(30), o);
  EXPECT_THAT(p.tip.doubt, testing::HasSubstr("is the largest that was tried"));
  EXPECT_THAT(p.warnings,
              testing::Contains(testing::HasSubstr("not to be trusted: its threshold of")));
  o = {};
  o.tip = p.tip;  // as from a file
  const PreparedAfm again = prepare_afm(walls(30), o);
  EXPECT_EQ(again.tip.doubt, p.tip.doubt);
  EXPECT_THAT(
      again.warnings,
      testing::Contains(testing::HasSubstr("tip: it says that this tip is not to be trusted")));
}

TEST(AfmPreparation, RefusesWhatCannotBe) {
  AfmPreparationOptions even, wide;
  even.tip_size = 8;
  EXPECT_THROW(prepare_afm(scan(5), even), UsageError);
  wide.tip_size = 99;
  EXPECT_THROW(prepare_afm(scan(5), wide), UsageError);
  HeightField quiet = make_mesa({495, 395, pitch}, 60, 120, 15);
  EXPECT_THROW(prepare_afm(quiet), InvalidInput);  // no noise to judge tips by
}

}  // namespace
}  // namespace surf::workflow
