// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/triangle_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "random_direction.h"
#include "surf/core/random.h"

namespace surf {
namespace {

Vec3 anywhere(RandomStream& random) { return test::isotropic(random) * (3 * random.uniform()); }

/// By trying many points of the triangle.
double least_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  constexpr int steps = 60;
  double least = HUGE_VAL;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j)
      least = std::min(
          least, length(a + (b - a) * (double(i) / steps) + (c - a) * (double(j) / steps) - p));
  return least;
}

TEST(ClosestPoint, NoPointOfTheTriangleIsNearer) {
  RandomStream random(1, 2, 3);
  for (int i = 0; i < 400; ++i) {
    const Vec3 a = anywhere(random), b = anywhere(random), c = anywhere(random),
               p = anywhere(random);
    const double found = length(closest_point(a, b, c, p) - p), tried = least_distance(a, b, c, p);
    EXPECT_LE(found, tried + 1e-12);
    EXPECT_NEAR(found, tried, 0.06);
  }
}

TEST(ClosestPoint, OfALineOrAPointIsOnIt) {
  RandomStream random(2, 2, 3);
  for (int i = 0; i < 400; ++i) {
    const Vec3 a = anywhere(random), b = anywhere(random), p = anywhere(random),
               middle = (a + b) * 0.5;
    const double to_line = least_distance(a, b, a, p);
    for (const auto& [u, v, w] :
         {std::tuple{a, a, b}, {a, b, a}, {b, a, a}, {a, b, b}, {a, b, middle}, {a, middle, b}}) {
      const Vec3 q = closest_point(u, v, w, p);
      EXPECT_NEAR(length(q - p), to_line, 0.06);
    }
    EXPECT_EQ(closest_point(a, a, a, p), a);
  }
}

TEST(HalfSolidAngle, OfAClosedTetrahedronIsTwoPiInsideAndNothingOutside) {
  const Vec3 v[4] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto around = [&](const Vec3& p) {
    double sum = 0;
    for (const auto& f : faces) sum += half_solid_angle(v[f[0]] - p, v[f[1]] - p, v[f[2]] - p);
    return sum;
  };
  EXPECT_NEAR(std::fabs(around({0.1, -0.05, 0.02})), 6.283185307179586, 1e-12);
  EXPECT_NEAR(around({4, 0.3, -1}), 0, 1e-12);
}

TEST(HalfSolidAngle, OfATriangleEdgeOnOrWithoutAreaIsNothing) {
  EXPECT_EQ(half_solid_angle({1, 0, 0}, {2, 0, 0}, {1, 1, 0}), 0);
  EXPECT_EQ(half_solid_angle({1, 2, 3}, {1, 2, 3}, {2, 1, 4}), 0);
}

}  // namespace
}  // namespace surf
