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
  const TruthReport report = compare_with_truth(r, truth);
  // A quarter each of -4, -5, -6 and -7.
  EXPECT_NEAR(report.offset_nm, -5, 1e-9);
  EXPECT_NEAR(report.rms_nm, std::sqrt(1.5), 0.01);
  EXPECT_NEAR(report.coverage_1, 0.25, 0.01);
  EXPECT_NEAR(report.coverage_2, 0.75, 0.01);
  ASSERT_FALSE(report.regions.empty());
  for (const RegionReport& region : report.regions)
    if (region.pixels > 100) EXPECT_NEAR(region.coverage_2, 0.75, 0.1) << region.name;
}

}  // namespace
}  // namespace surf::workflow
