// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/feature_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/open_sheet.h"

namespace surf {
namespace {

/// u where a polyline passes a height.
double at_height(const std::vector<Point2>& points, double z) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (points[i].y <= z && points[i + 1].y >= z && points[i + 1].y > points[i].y)
      return points[i].x +
             (z - points[i].y) / (points[i + 1].y - points[i].y) * (points[i + 1].x - points[i].x);
  return std::nan("");
}

TEST(FeatureShape, AWallPassesTheMiddleAtHalfItsHeight) {
  for (const double angle : {70.0, 90.0, 100.0}) {
    const auto wall = wall_profile({80, angle, 5, 8});
    EXPECT_NEAR(at_height(wall, 40), 0, 1e-9) << angle;
    EXPECT_NEAR(wall.front().y, 0, 1e-9);
    EXPECT_NEAR(wall.back().y, 80, 1e-9);
    // The flank's slope.
    EXPECT_NEAR(std::atan2(10, at_height(wall, 45) - at_height(wall, 35)) * 180 / M_PI, angle,
                1e-6);
  }
}

TEST(FeatureShape, CornersAreArcsThatTouchGroundFlankAndTop) {
  const auto wall = wall_profile({100, 90, 10, 20});
  EXPECT_NEAR(wall.front().x, -20, 1e-9);
  EXPECT_NEAR(wall.back().x, 10, 1e-9);
  EXPECT_NEAR(at_height(wall, 20), 0, 1e-9);
  for (const Point2& p : wall)
    if (p.y < 20) {
      EXPECT_NEAR(std::hypot(p.x + 20, p.y - 20), 20, 1e-9);
    }
}

TEST(FeatureShape, SharpCornersHaveOnePoint) {
  const auto wall = wall_profile({100, 80, 0, 0});
  ASSERT_EQ(wall.size(), 2u);
  EXPECT_NEAR(wall[1].x - wall[0].x, 100 / std::tan(80 * M_PI / 180), 1e-9);
  EXPECT_NEAR(wall_extent({100, 80, 0, 0}).top_nm, 50 / std::tan(80 * M_PI / 180), 1e-9);
}

TEST(FeatureShape, MeshesAreSheetsAlsoWhereTheyAreUndercut) {
  for (const FeatureKind kind :
       {FeatureKind::line, FeatureKind::trench, FeatureKind::edge, FeatureKind::hole})
    for (const double angle : {75.0, 90.0, 98.0})
      for (const double pitch : {0.0, 150.0}) {
        const TriangleMesh mesh = feature_mesh({kind, 70, pitch, {60, angle, 4, 3}}, 400);
        std::string reason;
        EXPECT_TRUE(extend_open_sheet(mesh, 1000, reason).has_value())
            << name(kind) << " " << angle << ": " << reason;
      }
}

TEST(FeatureShape, RefusesWallsThatMeet) {
  EXPECT_THROW(wall_profile({10, 90, 6, 6}), InvalidInput);
  EXPECT_THROW(wall_profile({0, 90, 1, 1}), InvalidInput);
  EXPECT_THROW(wall_profile({10, 20, 1, 1}), InvalidInput);
  EXPECT_THROW(feature_mesh({FeatureKind::line, 10, 0, {100, 80, 0, 0}}, 100), InvalidInput);
  EXPECT_THROW(feature_mesh({FeatureKind::line, 90, 95, {100, 80, 0, 0}}, 100), InvalidInput);
  EXPECT_THROW(feature_mesh({FeatureKind::hole, 10, 0, {100, 80, 0, 0}}, 100), InvalidInput);
  EXPECT_THROW(parse_feature_kind("pillar", "`profile.kind`"), UsageError);
}

}  // namespace
}  // namespace surf
