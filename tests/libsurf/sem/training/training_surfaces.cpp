// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/training_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "surf/core/error.h"
#include "surf/sem/surface_range.h"

namespace surf {
namespace {

TEST(TrainingSurfaces, AreWholeCentredAndDifferent) {
  for (const double pixel : {0.5, 1.0, 3.0, 10.0}) {
    std::set<std::string> names;
    std::set<std::vector<double>> heights;
    for (const NamedSurface& s : training_surfaces({pixel, 48, 26, 7})) {
      SCOPED_TRACE(s.name);
      validate(s.field);
      EXPECT_EQ(s.field.z_nm.width(), 48);
      EXPECT_EQ(s.field.z_nm.height(), 48);
      EXPECT_EQ(s.field.pitch_x_nm, pixel);
      EXPECT_NEAR(s.field.origin_x_nm, -23.5 * pixel, 1e-9);
      EXPECT_TRUE(names.insert(s.name).second);
      EXPECT_TRUE(heights.insert(s.field.z_nm.data()).second);
    }
  }
}

TEST(TrainingSurfaces, CoverGentleAndSteepSlopesAtEveryPixelSize) {
  for (const double pixel : {0.5, 1.0, 3.0, 10.0}) {
    SCOPED_TRACE(pixel);
    SurfaceRange all;
    double gentlest = 90;
    for (const NamedSurface& s : training_surfaces({pixel, 96, 20, 1})) {
      const SurfaceRange range = surface_range(s.field);
      all = united(all, range);
      gentlest = std::min(gentlest, range.slope_deg_p99);
    }
    EXPECT_GT(all.slope_deg_max, 75);
    EXPECT_LT(all.slope_deg_max, 89.5);
    EXPECT_LT(gentlest, 55);
  }
}

TEST(TrainingSurfaces, DependOnTheSeedAndOnNothingElse) {
  const auto a = training_surfaces({3, 32, 21, 1}), b = training_surfaces({3, 32, 21, 1});
  const auto other = training_surfaces({3, 32, 21, 2}), fewer = training_surfaces({3, 32, 4, 1});
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].field.z_nm, b[i].field.z_nm);
    EXPECT_NE(a[i].field.z_nm, other[i].field.z_nm);
    if (i < fewer.size()) {
      EXPECT_EQ(a[i].field.z_nm, fewer[i].field.z_nm);
    }
  }
  EXPECT_EQ(a[20].name, a[0].name + "-2");
}

TEST(TrainingSurfaces, WorkInTheSmallestField) {
  for (const NamedSurface& s : training_surfaces({0.1, 16, 20, 3}))
    EXPECT_NO_THROW(validate(s.field)) << s.name;
}

TEST(TrainingSurfaces, RefuseWhatIsOutOfRange) {
  for (const TrainingSurfaceOptions& bad :
       {TrainingSurfaceOptions{0, 96, 16, 1}, TrainingSurfaceOptions{NAN, 96, 16, 1},
        TrainingSurfaceOptions{3, 15, 16, 1}, TrainingSurfaceOptions{3, 5000, 16, 1},
        TrainingSurfaceOptions{3, 96, 0, 1}})
    EXPECT_THROW(training_surfaces(bad), UsageError);
}

}  // namespace
}  // namespace surf
