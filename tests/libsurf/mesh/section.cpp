// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/mesh/shapes.h"

namespace surf {

namespace {

double total_length(const std::vector<std::array<Vec3, 2>>& pieces) {
  double sum = 0;
  for (const auto& [a, b] : pieces) sum += length(b - a);
  return sum;
}

}  // namespace

TEST(SectionAtY, OfABoxIsItsRectangle) {
  const TriangleMesh box = make_box({-10, -5, 0}, {10, 5, 30}, 3);
  for (const double y : {-4.999, 0.0, 1.0}) {
    const auto pieces = section_at_y(box, y);
    EXPECT_NEAR(total_length(pieces), 2 * (20 + 30), 1e-9) << y;
    for (const auto& [a, b] : pieces) EXPECT_EQ(a.y, y);
  }
  EXPECT_TRUE(section_at_y(box, 5.1).empty());
  EXPECT_TRUE(section_at_y(box, -5).empty()) << "the plane only touches it";
}

TEST(SectionAtY, ThroughVerticesCountsEveryEdgeOnce) {
  // Rows of vertices of the subdivided box lie at y = -5/3 exactly on edges of triangles.
  const TriangleMesh box = make_box({-3, -3, 0}, {3, 3, 6}, 3);
  EXPECT_NEAR(total_length(section_at_y(box, -1)), 2 * (6 + 6), 1e-9);
}

TEST(SectionAtY, OfASphereIsNearlyACircle) {
  const auto pieces = section_at_y(make_sphere({0, 0, 0}, 10, 5), 6);
  EXPECT_NEAR(total_length(pieces), 2 * M_PI * 8, 0.1);
}

}  // namespace surf
