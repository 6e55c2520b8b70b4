// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double degree = std::numbers::pi / 180;

}  // namespace

TEST(MeasureTip, FindsAParabola) {
  const TipMeasures m = measure_tip(parabolic_tip(12, {0.5, 0.8, 81, 51}));
  EXPECT_NEAR(m.radius_nm, 12, 1e-6);
  EXPECT_NEAR(m.smallest_radius_nm, 12, 1e-6);
  EXPECT_NEAR(m.largest_radius_nm, 12, 1e-6);
  EXPECT_LT(m.radius_residual_nm, 1e-9);
  EXPECT_GE(m.samples, 21);
}

TEST(MeasureTip, FindsASphere) {
  const TipMeasures m = measure_tip(ball_tip(10, 1, 0, {0.5, 0.5, 61, 61}), {.fit_depth_nm = 4});
  EXPECT_NEAR(m.sphere_radius_nm, 10, 1e-6);
  EXPECT_LT(m.sphere_residual_nm, 1e-6);
  EXPECT_GT(m.radius_residual_nm, 1e-3);  // it is no paraboloid
}

TEST(MeasureTip, TellsTheTwoRadiiOfAnEllipticTip) {
  Tip tip{{1, 1}, Grid<double>(31, 31), 12, 18};
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x) {
      const double u = (x - 12 + y - 18) / std::sqrt(2.0), v = (x - 12 - y + 18) / std::sqrt(2.0);
      tip.z_nm(x, y) = -u * u / (2 * 5.0) - v * v / (2 * 20.0);
    }
  const TipMeasures m = measure_tip(tip);
  EXPECT_NEAR(m.smallest_radius_nm, 5, 1e-6);
  EXPECT_NEAR(m.largest_radius_nm, 20, 1e-6);
  EXPECT_NEAR(m.radius_nm, 8, 1e-6);
}

TEST(MeasureTip, FindsTheAngleOfConesAndPyramids) {
  for (const double angle : {15.0, 35.0, 60.0}) {
    const TipMeasures m = measure_tip(conical_tip(3, angle * degree, {0.25, 0.25, 201, 201}));
    ASSERT_TRUE(m.half_angle_rad);
    EXPECT_NEAR(*m.half_angle_rad, angle * degree, 0.4 * degree) << angle;
    EXPECT_LT(m.half_angle_residual_nm, 0.05);
  }
  // The cone of the same cross section: area 4 (z tan a)^2 = pi (z tan b)^2.
  const Tip pyramid =
      pyramidal_tip({std::vector<double>(4, 30 * degree), 0.4, 0}, {0.25, 0.25, 201, 201});
  const TipMeasures m = measure_tip(pyramid);
  ASSERT_TRUE(m.half_angle_rad);
  EXPECT_NEAR(std::tan(*m.half_angle_rad), std::tan(30 * degree) * std::sqrt(4 / std::numbers::pi),
              0.01);
}

TEST(MeasureTip, OfAFlatEndTheRadiusIsInfinite) {
  const TipMeasures m = measure_tip({{1, 1}, Grid<double>(9, 9, 0.0), 4, 4});
  EXPECT_TRUE(std::isinf(m.radius_nm));
  EXPECT_TRUE(std::isinf(m.sphere_radius_nm));
  EXPECT_FALSE(m.half_angle_rad);
}

TEST(MeasureTip, RoundingIsNoRadius) {
  Tip tip{{2, 2}, Grid<double>(15, 15, 0.0), 7, 7};
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 15; ++x) {
      const double r = 2 * std::hypot(x - 7, y - 7);
      tip.z_nm(x, y) = -(r < 8 ? 1e-6 * r : r - 8);  // a plateau
    }
  EXPECT_TRUE(std::isinf(measure_tip(tip).radius_nm));
  EXPECT_LT(measure_tip(tip, {.fit_depth_nm = 8}).radius_nm, 30);
}

TEST(MeasureTip, Refuses) {
  EXPECT_THROW(measure_tip({{1, 1}, Grid<double>(2, 2, 0.0), 0, 0}), InvalidInput);
  EXPECT_THROW(measure_tip(parabolic_tip(5, {}), {.fit_depth_nm = -1}), InvalidInput);
  EXPECT_THROW(measure_tip(parabolic_tip(5, {}), {.cone_to_nm = std::nan("")}), InvalidInput);
}

TEST(TipVolume, IsThatOfTheSolid) {
  const double pi = std::numbers::pi;
  EXPECT_NEAR(tip_volume_nm3(parabolic_tip(10, {0.1, 0.1, 301, 301}), 5), pi * 10 * 25, 1);
  EXPECT_NEAR(tip_volume_nm3(conical_tip(0, 45 * degree, {0.1, 0.2, 301, 151}), 10), pi * 1000 / 3,
              2);
  EXPECT_NEAR(tip_volume_nm3(ball_tip(5, 1, 0, {0.05, 0.05, 221, 221}), 5), 2 * pi * 125 / 3, 1);
  EXPECT_THROW(tip_volume_nm3(parabolic_tip(5, {}), 0), InvalidInput);
}

}  // namespace surf
