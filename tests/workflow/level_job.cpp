// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/level_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "heard.h"
#include "surf/afm/noise.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A block on a tilted plane; row 7 is shifted.
HeightField scan(double noise_nm2 = 1e-4) {
  HeightField f{{2, 2}, Grid<double>(60, 50)};
  const Grid<double> noise = simulate_noise({0, noise_nm2}, 60, 50, 3);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x)
      f.z_nm(x, y) = 0.05 * f.x_nm(x) + (x > 20 && x < 40 && y > 15 && y < 30 ? 20 : 0) +
                     (y == 7 ? 3 : 0) + noise(x, y);
  return f;
}

TEST(LevelJob, TakesThePlaneOfTheSubstrateOff) {
  test::Heard heard;
  const LevelResult r = level(scan(), {}, {}, heard.reporter());
  EXPECT_NEAR(r.tilt_deg, std::atan(0.05) * 180 / 3.14159265, 0.01);
  EXPECT_NEAR(r.field.z_nm(5, 40), 0, 0.1);
  EXPECT_NEAR(r.field.z_nm(30, 20), 20, 0.1);
  EXPECT_EQ(r.substrate(5, 40), 1);
  EXPECT_EQ(r.substrate(30, 20), 0);
  EXPECT_THAT(heard.warnings, testing::IsEmpty());
  EXPECT_GT(heard.furthest, 0.8);
}

TEST(LevelJob, TakesStepsBetweenRowsOff) {
  LevelParameters p;
  p.method = LevelMethod::plane;
  p.rows = RowMethod::median;
  Mask left(60, 50);  // without the block
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 20; ++x) left(x, y) = 1;
  const LevelResult r = level(scan(), p, left);
  ASSERT_TRUE(r.rows);
  EXPECT_NEAR(r.rows->offsets_nm[7], 3, 0.3);
  EXPECT_NEAR(r.field.z_nm(5, 7), 0, 0.05);
  EXPECT_NEAR(r.field.z_nm(30, 20), 20, 0.1);
}

TEST(LevelJob, OtherMethodsMarkNoSubstrate) {
  LevelParameters p;
  p.method = LevelMethod::plane;
  const LevelResult plane = level(scan(), p);
  EXPECT_TRUE(plane.plane);
  EXPECT_TRUE(plane.substrate.empty());
  p.method = LevelMethod::polynomial;
  EXPECT_FALSE(level(scan(), p).plane);
  p.method = LevelMethod::none;
  EXPECT_EQ(level(scan(), p).field.z_nm, scan().z_nm);
}

TEST(LevelJob, SaysWhatMayBeWrongByTheNamesOfFields) {
  HeightField rough{{2, 2}, Grid<double>(60, 50)};
  rough.z_nm = simulate_noise({0, 100}, 60, 50, 5);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) rough.z_nm(x, y) += x < 30 ? 0 : 100 + 3 * (x - 30);
  LevelParameters p;
  p.tolerance_nm = 0.5;
  test::Heard heard;
  level(rough, p, {}, heard.reporter());
  EXPECT_THAT(heard.warnings, Contains(HasSubstr("`level.method=plane` may be what is wanted")));
}

TEST(LevelJob, RefusesWhatDoesNotFit) {
  LevelParameters p;
  p.degree = 7;
  EXPECT_THROW(level(scan(), p), UsageError);
  p = {};
  p.method = LevelMethod::plane;
  p.tolerance_nm = 1;
  EXPECT_THROW(level(scan(), p), UsageError);
}

TEST(LevelJob, EndsWhereItIsCancelled) {
  CancelToken token;
  token.cancel();
  Reporter reporter;
  reporter.cancel = &token;
  EXPECT_THROW(level(scan(), {}, {}, reporter), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
