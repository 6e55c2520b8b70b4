// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/surface_range.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

HeightField field_of(int w, int h, double pitch, double (*z)(double, double)) {
  HeightField field{{pitch, pitch}, Grid<double>(w, h)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) field.z_nm(x, y) = z(field.x_nm(x), field.y_nm(y));
  return field;
}

TEST(SurfaceRange, OfATiltedPlaneIsItsSlope) {
  const SurfaceRange range =
      surface_range(field_of(9, 7, 2, [](double x, double y) { return 3 * x + 4 * y; }));
  EXPECT_NEAR(range.slope_deg_max, std::atan(5) * 180 / M_PI, 1e-9);
  EXPECT_NEAR(range.slope_deg_p99, range.slope_deg_max, 1e-9);
  EXPECT_NEAR(range.curvature_max_per_nm, 0, 1e-12);
}

TEST(SurfaceRange, OfAParabolaIsItsSecondDerivative) {
  const SurfaceRange range =
      surface_range(field_of(9, 9, 2, [](double x, double) { return 0.25 * x * x; }));
  EXPECT_NEAR(range.curvature_max_per_nm, 0.5, 1e-12);
  EXPECT_NEAR(range.slope_deg_max, std::atan(0.5 * 15) * 180 / M_PI,
              1e-9);  // on the rim between 14 and 16 nm
}

TEST(SurfaceRange, UnitesToWhatHoldsBoth) {
  EXPECT_EQ(united({1, 20, 3, 40}, {10, 2, 30, 4}), (SurfaceRange{10, 20, 30, 40}));
}

TEST(SurfaceRange, CountsWhatIsSteeper) {
  HeightField step = field_of(10, 4, 1, [](double x, double) { return x > 4.5 ? 100.0 : 0.0; });
  EXPECT_DOUBLE_EQ(share_steeper(step, 45), 0.2);
  EXPECT_DOUBLE_EQ(share_steeper(step, 89.9), 0);
}

TEST(SurfaceRange, WorksOnTheSmallestFieldAndRefusesHoles) {
  HeightField field = field_of(2, 2, 1, [](double x, double) { return x; });
  EXPECT_NEAR(surface_range(field).slope_deg_max, 45, 1e-9);
  field.valid = Mask(2, 2, 1);
  field.valid(0, 0) = 0;
  EXPECT_THROW(surface_range(field), InvalidInput);
}

}  // namespace
}  // namespace surf
