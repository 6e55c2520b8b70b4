// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/horizon_map.h"

#include <algorithm>

#include "geometry/embree_scene.h"
#include "random_direction.h"
#include "statistics.h"
#include "surf/core/random.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using test::isotropic;

// Rays that leave the surface, and rays from anywhere around it; never free where the ray tracer
// hits from outside. The answer is the share proven of those that leave and are free.
double share_of_free(const TriangleMesh& mesh, const Box& domain, bool from_tops) {
  const HorizonMap sky(mesh, domain, 1 << 12);
  const EmbreeScene rays(mesh);
  RandomStream random(1, mesh.triangles.size(), 0);
  const Vec3 size = domain.size_nm();
  int free = 0, proven = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 d = isotropic(random);
    Vec3 p{domain.lower_nm.x + size.x * random.uniform(),
           domain.lower_nm.y + size.y * random.uniform(),
           domain.lower_nm.z - 5 + (size.z + 10) * random.uniform()};
    const bool leaves = i % 2 == 0;
    EmbreeScene::Hit hit;
    const auto any = [](void*, std::uint32_t, double, double) { return true; };
    // What was left a rounding error ago is not met.
    const auto ahead = [](void*, std::uint32_t, double, double distance) {
      return distance > 1e-6;
    };
    if (leaves) {
      p.z = domain.upper_nm.z + 10;
      if (!rays.nearest(p, {0, 0, -1}, HUGE_VAL, any, nullptr, hit)) continue;
      p = hit.position;
      if (from_tops && dot(hit.normal, d) <= 0) continue;
    }
    const bool meets = rays.nearest(p, d, HUGE_VAL, ahead, nullptr, hit);
    if (meets && dot(hit.normal, d) > 0) continue;  // it began in matter
    const bool says = sky.is_free(p, d);
    EXPECT_FALSE(says && meets) << p.x << " " << p.y << " " << p.z << ", " << d.x << " " << d.y
                                << " " << d.z;
    if (testing::Test::HasFailure()) return 0;
    if (leaves && d.z > 0 && !meets) {
      ++free;
      proven += says;
    }
  }
  const double share = static_cast<double>(proven) / std::max(free, 1);
  testing::Test::RecordProperty("share_of_" + std::to_string(mesh.triangles.size()),
                                std::to_string(share));
  return share;
}

}  // namespace

TEST(HorizonMap, IsNeverFreeWhereSomethingIsMet) {
  const HeightField mesa = make_mesa({200, 200, 4}, 60, 60, 8);
  const double of_mesa =
      share_of_free(half_space_top(mesa, 4000), bounds(height_field_sheet(mesa)), true);
  EXPECT_GT(of_mesa, 0.7);
  const HeightField rough = make_rough({120, 120, 2}, 8, 25, 1);
  EXPECT_GT(share_of_free(half_space_top(rough, 2000), bounds(height_field_sheet(rough)), true),
            0.2);
  HeightField gentle = rough;
  for (double& z : gentle.z_nm.data()) z *= 0.2;
  EXPECT_GT(share_of_free(half_space_top(gentle, 2000), bounds(height_field_sheet(gentle)), true),
            0.5);
  TriangleMesh cubes = make_box({-50, -50, 0}, {-10, 50, 33.3});
  const TriangleMesh roof = make_box({20, -30, 40}, {60, 30, 44});
  const auto base = static_cast<std::uint32_t>(cubes.vertices_nm.size());
  cubes.vertices_nm.insert(cubes.vertices_nm.end(), roof.vertices_nm.begin(),
                           roof.vertices_nm.end());
  for (const Triangle& t : roof.triangles)
    cubes.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  EXPECT_GT(share_of_free(cubes, bounds(cubes), true), 0.6);
}

TEST(HorizonMap, AllowsForWhatLiesOutsideItsColumns) {
  const HeightField mesa = make_mesa({200, 200, 4}, 60, 60, 8);
  Box part;
  part.extend(Vec3{50, 20, 0});
  part.extend(Vec3{95, 90, 60});
  share_of_free(half_space_top(mesa, 4000), part, true);
}

TEST(HorizonMap, KnowsTheWallNextToAPoint) {
  // Columns of 2 nm, and steep rays that meet a wall in the next one, just below its top.
  TriangleMesh walls = make_box({-32, -32, 0}, {32, 32, 1});
  const TriangleMesh box = make_box({-10.1, -10.1, 1}, {10.1, 10.1, 11});
  const auto base = static_cast<std::uint32_t>(walls.vertices_nm.size());
  walls.vertices_nm.insert(walls.vertices_nm.end(), box.vertices_nm.begin(), box.vertices_nm.end());
  for (const Triangle& t : box.triangles)
    walls.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  const HorizonMap sky(walls, bounds(walls), 1 << 10);
  const EmbreeScene rays(walls);
  RandomStream random(5, 0, 0);
  int met = 0, free = 0;
  for (int i = 0; i < 100000; ++i) {
    const double turn = 6.283185307 * random.uniform();
    const Vec3 out{std::cos(turn), std::sin(turn), 0};
    const double far = 10.1 / std::max(std::fabs(out.x), std::fabs(out.y)) + 4 * random.uniform();
    const Vec3 p = out * far + Vec3{0, 0, 11 - 4 * random.uniform()};
    const Vec3 d = normalized(isotropic(random) + Vec3{0, 0, 1.5});
    EmbreeScene::Hit hit;
    const auto ahead = [](void*, std::uint32_t, double, double distance) {
      return distance > 1e-6;
    };
    const bool meets = rays.nearest(p, d, HUGE_VAL, ahead, nullptr, hit);
    const bool says = sky.is_free(p, d);
    ASSERT_FALSE(says && meets) << p.x << " " << p.y << " " << p.z;
    met += meets;
    free += says;
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(free, 100);
}

TEST(HorizonMap, KnowsTheNextToothWithinAColumn) {
  // Teeth much narrower than columns: by the next column a ray from between them is above all
  // others.
  HeightField teeth;
  teeth.pitch_x_nm = teeth.pitch_y_nm = 0.25;
  teeth.z_nm = Grid<double>(129, 129);
  for (int y = 0; y < 129; ++y)
    for (int x = 0; x < 129; ++x) teeth.z_nm(x, y) = 0.5 * std::abs(x % 4 - 2);
  const TriangleMesh top = height_field_sheet(teeth);
  const HorizonMap sky(top, bounds(top), 1 << 8);
  const EmbreeScene rays(top);
  RandomStream random(6, 0, 0);
  int met = 0, free = 0;
  for (int i = 0; i < 100000; ++i) {
    const auto any = [](void*, std::uint32_t, double, double) { return true; };
    const auto ahead = [](void*, std::uint32_t, double, double distance) {
      return distance > 1e-6;
    };
    const Vec3 over{8 + 16 * random.uniform(), 8 + 16 * random.uniform(), 5};
    EmbreeScene::Hit hit;
    ASSERT_TRUE(rays.nearest(over, {0, 0, -1}, HUGE_VAL, any, nullptr, hit));
    const Vec3 d = normalized(isotropic(random) + Vec3{0, 0, 1});
    if (dot(hit.normal, d) <= 0) continue;
    const Vec3 p = hit.position;
    const bool meets = rays.nearest(p, d, HUGE_VAL, ahead, nullptr, hit);
    const bool says = sky.is_free(p, d);
    ASSERT_FALSE(says && meets) << p.x << " " << p.y << " " << p.z;
    met += meets;
    free += says;
  }
  EXPECT_GT(met, 10000);
  EXPECT_GT(free, 10000);
}

TEST(HorizonMap, IsNotFreeBelowARoofNorDownward) {
  const TriangleMesh roof = make_box({-20, -20, 10}, {20, 20, 12});
  const HorizonMap sky(roof, bounds(roof), 1 << 10);
  EXPECT_FALSE(sky.is_free({0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(sky.is_free({0, 0, 20}, {0, 0, -1}));
  EXPECT_TRUE(sky.is_free({0, 0, 12}, {0, 0, 1}));
  EXPECT_TRUE(sky.is_free({0, 0, 12}, {0.6, 0, 0.8}));
}

}  // namespace surf::mc
