// SPDX-License-Identifier: GPL-3.0-or-later
#include "distance_grid.h"

#include <algorithm>

#include "statistics.h"
#include "surf/core/random.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
  return length(p - a - ab * t);
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = normalized(cross(b - a, c - a));
  const auto left_of = [&](const Vec3& u, const Vec3& v) { return dot(cross(v - u, p - u), n) >= 0; };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::fabs(dot(p - a, n));
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c),
                   distance_to_segment(p, c, a)});
}

double distance(const TriangleMesh& mesh, const Vec3& p) {
  double best = HUGE_VAL;
  for (const Triangle& t : mesh.triangles)
    best = std::min(best, distance_to_triangle(p, mesh.vertices_nm[t[0]], mesh.vertices_nm[t[1]],
                                               mesh.vertices_nm[t[2]]));
  return best;
}

// The proof by trial: no bound exceeds the true distance; and the bounds are good for something.
void expect_bounds(const TriangleMesh& mesh, const Box& domain, std::size_t bytes) {
  const DistanceGrid grid(mesh, domain, bytes);
  RandomStream random(1, bytes, mesh.triangles.size());
  const Vec3 size = domain.size_nm(), margin = size * 0.2;
  double lost = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const Vec3 p{domain.lower_nm.x - margin.x + (size.x + 2 * margin.x) * random.uniform(),
                 domain.lower_nm.y - margin.y + (size.y + 2 * margin.y) * random.uniform(),
                 domain.lower_nm.z - margin.z + (size.z + 2 * margin.z) * random.uniform()};
    const double d = distance(mesh, p), bound = grid.bound_nm(p);
    ASSERT_GE(bound, 0);
    ASSERT_LE(bound, d) << p.x << " " << p.y << " " << p.z;
    lost += std::max(0.0, std::min(d, 15 * grid.cell_nm()) - bound) / grid.cell_nm();
  }
  EXPECT_LT(lost / n, 5) << "cells short of the true distance, on average";
}

}  // namespace

TEST(DistanceGrid, IsNeverMoreThanTheDistance) {
  const TriangleMesh box = make_box({-50, -40, -30}, {50, 40, 30});
  expect_bounds(box, bounds(box), 1 << 18);
  const TriangleMesh ball = make_sphere({100, 0, -7}, 40, 3);
  expect_bounds(ball, bounds(ball), 1 << 16);
  expect_bounds(ball, bounds(ball), 1 << 10);
}

TEST(DistanceGrid, AllowsForSurfacesOutsideItsDomain) {
  const TriangleMesh sheet =
      half_space_top(make_mesa({120, 120, 6}, 60, 30, 10), 1000);
  Box domain;
  domain.extend(Vec3{-30, -30, 0});
  domain.extend(Vec3{30, 30, 60});
  const DistanceGrid grid(sheet, domain, 1 << 16);
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p{80 * (random.uniform() - 0.5), 80 * (random.uniform() - 0.5),
                 -20 + 100 * random.uniform()};
    ASSERT_LE(grid.bound_nm(p), distance(sheet, p));
  }
}

TEST(DistanceGrid, WithoutMemoryBoundsOnlyOutsideTheBox) {
  const TriangleMesh box = make_box({-50, -50, -50}, {50, 50, 50});
  const DistanceGrid grid(box, bounds(box), 0);
  EXPECT_EQ(grid.bound_nm({0, 0, 0}), 0);
  EXPECT_NEAR(grid.bound_nm({0, 0, 80}), 30, 0.01);
}

}  // namespace surf::mc
