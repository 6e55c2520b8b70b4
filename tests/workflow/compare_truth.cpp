// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare_truth.h"

#include <gmock/gmock.h>

#include <cmath>

#include "surf/mesh/shapes.h"

namespace surf::workflow {
namespace {

TEST(CompareTruth, TakesOffTheMedianAndCountsWhatIsCovered) {
  Reconstruction r;
  r.surface = make_rough({60, 60, 3}, 4, 9, 1);
  r.start = r.surface;
  HeightField truth = r.surface;
  for (std::size_t i = 0; i < truth.z_nm.size(); ++i)
    truth.z_nm.data()[i] += 5 + static_cast<double>(i % 4) - 1;
  r.deviation_nm = Grid<double>(truth.z_nm.width(), truth.z_nm.height(), 0.75);
  r.lower_nm = r.upper_nm = r.surface.z_nm;
  for (double& v : r.lower_nm.data()) v -= 0.2;  // uneven: truths of +0 and +1 are inside
  for (double& v : r.upper_nm.data()) v += 1.1;
  const TruthReport report = compare_with_truth(r, truth);
  // A quarter each of -4, -5, -6 and -7.
  EXPECT_NEAR(report.offset_nm, -5, 1e-9);
  EXPECT_NEAR(report.rms_nm, std::sqrt(1.5), 0.01);
  EXPECT_NEAR(report.coverage_1, 0.25, 0.01);
  EXPECT_NEAR(report.coverage_2, 0.75, 0.01);
  EXPECT_NEAR(report.in_interval, 0.5, 0.01);
  ASSERT_FALSE(report.regions.empty());
  for (const RegionReport& region : report.regions)
    if (region.pixels > 100) {
      EXPECT_NEAR(region.coverage_2, 0.75, 0.1) << region.name;
    }
}

/// A trench whose walls are displaced by 4 nm to the right, where 3 nm are stated.
TEST(CompareTruth, JudgesWallsByTheirPlace) {
  HeightField truth;
  truth.pitch_x_nm = truth.pitch_y_nm = 10;
  truth.z_nm = Grid<double>(80, 20);
  const auto height = [](double x_nm) {
    return 60 - 60 * std::clamp((x_nm - 200) / 30, 0.0, 1.0) +
           60 * std::clamp((x_nm - 500) / 30, 0.0, 1.0);
  };
  Reconstruction r;
  r.surface = truth;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 80; ++x) {
      truth.z_nm(x, y) = height(truth.x_nm(x));
      r.surface.z_nm(x, y) = height(truth.x_nm(x) - 4);
    }
  r.deviation_nm = Grid<double>(80, 20, 6.0);  // 3 nm along x at a slope of 2
  r.lower_nm = r.upper_nm = r.surface.z_nm;
  // Only walls that fall to the right are as much too high as intervals say.
  for (double& v : r.lower_nm.data()) v -= 9;
  for (double& v : r.upper_nm.data()) v += 1;
  const TruthReport report = compare_with_truth(r, truth);
  const RegionReport& edge = report.regions.back();
  ASSERT_EQ(edge.name, "edge");
  EXPECT_EQ(edge.pixels, 40);
  EXPECT_NEAR(edge.rms_nm, 4, 1e-6);
  EXPECT_NEAR(edge.stated_nm, 3, 1e-6);
  EXPECT_EQ(edge.coverage_1, 0);
  EXPECT_EQ(edge.coverage_2, 1);
  EXPECT_EQ(edge.in_interval, 0.5);
}

}  // namespace
}  // namespace surf::workflow
