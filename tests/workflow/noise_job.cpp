// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/noise_job.h"

#include <gmock/gmock.h>

#include "heard.h"
#include "surf/afm/noise.h"

namespace surf::workflow {
namespace {

TEST(NoiseJob, FindsTheModelOfAFlatScan) {
  HeightField f{{2, 2}, Grid<double>(100, 80)};
  f.z_nm = simulate_noise({0.6, 0.02}, 100, 80, 2);
  ScanNoiseParameters p;
  p.flat = true;
  const ScanNoise noise = noise_of_scan(f, p);
  EXPECT_NEAR(noise.estimate.noise.alpha, 0.6, 0.05);
  ASSERT_TRUE(noise.check);
  EXPECT_GT(noise.check->along_p, 0.001);
  EXPECT_EQ(noise.check->along.size(), 10u);
  EXPECT_FALSE(noise.plane);
}

TEST(NoiseJob, SaysWhereThereIsNone) {
  HeightField f{{2, 2}, Grid<double>(40, 30, 1.0)};
  ScanNoiseParameters p;
  p.flat = true;
  test::Heard heard;
  EXPECT_FALSE(noise_of_scan(f, p, {}, heard.reporter()).check);
  EXPECT_THAT(heard.warnings, testing::ElementsAre(testing::HasSubstr("no noise at all")));
}

TEST(NoiseJob, SaysWhereThereMayBeNoSubstrate) {
  HeightField rough{{2, 2}, Grid<double>(60, 50)};
  rough.z_nm = simulate_noise({0.9, 100}, 60, 50, 5);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) rough.z_nm(x, y) += x < 30 ? 0 : 400;
  test::Heard heard;
  const ScanNoise noise = noise_of_scan(rough, {}, {}, heard.reporter());
  ASSERT_TRUE(noise.plane);
  EXPECT_EQ(heard.warnings.size(), noise.plane->verdict == HoughVerdict::clear ? 0u : 1u);
  if (!heard.warnings.empty()) {
    EXPECT_THAT(heard.warnings[0], testing::HasSubstr("`scan.use` or `scan.exclude`"));
  }
}

}  // namespace
}  // namespace surf::workflow
