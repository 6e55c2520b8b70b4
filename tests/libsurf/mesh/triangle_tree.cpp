// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

Vec3 random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(random), u(random), u(random)};
}

double distance_by_looking_at_all(const TriangleTree& tree, const Vec3& p) {
  double least = HUGE_VAL;
  for (std::uint32_t t = 0; t < tree.mesh().triangles.size(); ++t)
    least = std::min(least, length(closest_point(tree.corners(t), p) - p));
  return least;
}

TEST(TriangleTree, FindsTheClosestTriangle) {
  const TriangleMesh mesh = make_sphere({3, -2, 1}, 10, 3);
  const TriangleTree tree(mesh);
  ASSERT_EQ(tree.size(), mesh.triangles.size());
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(random, 20);
    const double least = distance_by_looking_at_all(tree, p);
    for (const std::uint32_t start : {0u, 700u}) {
      const TriangleTree::Closest found = tree.closest(p, start);
      EXPECT_DOUBLE_EQ(found.distance_nm, least);
      EXPECT_DOUBLE_EQ(length(closest_point(tree.corners(found.triangle), p) - p), least);
    }
  }
}

TEST(TriangleTree, VisitsJustTheTrianglesWhoseBoxesMeetABox) {
  // Far from the origin, where single precision alone would be too coarse.
  const TriangleMesh mesh = make_sphere({1e6, -2e6, 3e6}, 10, 3);
  const TriangleTree tree(mesh);
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    Box box;
    box.extend(Vec3{1e6, -2e6, 3e6} + random_point(random, 12));
    box.extend(box.lower_nm + random_point(random, 3));
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (overlap(tree.box_of(t), box)) expected.insert(t);
    tree.visit_overlapping(box, [&](std::uint32_t t) { EXPECT_TRUE(found.insert(t).second); });
    EXPECT_EQ(found, expected);
  }
  Box corner;  // a box that is a vertex touches
  corner.extend(mesh.vertices_nm[17]);
  int touched = 0;
  tree.visit_overlapping(corner, [&](std::uint32_t) { ++touched; });
  EXPECT_GE(touched, 5);
}

TEST(TriangleTree, HoldsTheTrianglesNearARegionAlone) {
  const TriangleMesh mesh = make_sphere({}, 10, 4);
  Box region;
  region.extend(Vec3{5, 5, 5});
  region.extend(Vec3{11, 11, 11});
  const TriangleTree tree(mesh, region);
  std::size_t expected = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    expected += overlap(tree.box_of(t), region) ? 1 : 0;
  EXPECT_EQ(tree.size(), expected);
  tree.visit_near(
      {0, 0, 0}, [] { return 1e6; },
      [&](std::uint32_t t) { EXPECT_TRUE(overlap(tree.box_of(t), region)); });
  region.lower_nm = region.upper_nm = Vec3{100, 100, 100};
  const TriangleTree none(mesh, region);
  EXPECT_EQ(none.size(), 0u);
  none.visit_near(
      {}, [] { return HUGE_VAL; }, [](std::uint32_t) { FAIL(); });
  none.visit_overlapping(region, [](std::uint32_t) { FAIL(); });
}

TEST(TriangleTree, VisitsAllWithinAReach) {
  const TriangleMesh mesh = make_sphere({}, 10, 3);
  const TriangleTree tree(mesh, {}, 2);
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random_point(random, 15);
    const double reach = 0.5 + 0.01 * i;
    std::set<std::uint32_t> found;
    tree.visit_near(
        p, [&] { return reach * reach; }, [&](std::uint32_t t) { found.insert(t); });
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      EXPECT_TRUE(found.contains(t) || length(closest_point(tree.corners(t), p) - p) >= reach);
  }
}

TEST(TriangleTree, IsTheSameWithAnyThreads) {
  const TriangleMesh mesh = make_sphere({}, 10, 5);
  const auto order = [&](int threads) {
    std::vector<std::uint32_t> all;
    TriangleTree(mesh, {}, threads)
        .visit_near(
            {}, [] { return HUGE_VAL; }, [&](std::uint32_t t) { all.push_back(t); });
    return all;
  };
  EXPECT_EQ(order(1), order(3));
  EXPECT_EQ(order(1).size(), mesh.triangles.size());
}

TEST(TriangleTree, IsInterrupted) {
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(TriangleTree(make_sphere({}, 10, 5), Watch{{}, &cancel}), Interrupted);
}

}  // namespace
}  // namespace surf
