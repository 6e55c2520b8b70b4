// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;

std::size_t pairs(const TriangleMesh& mesh) { return find_self_intersections(mesh).pairs.size(); }

TriangleMesh two(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
  TriangleMesh mesh{{s.begin(), s.end()}, {{0, 1, 2}}};
  append(mesh, {{t.begin(), t.end()}, {{0, 1, 2}}});
  return mesh;
}

std::array<Vec3, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices_nm[a], mesh.vertices_nm[b], mesh.vertices_nm[c]};
}

}  // namespace

TEST(FindSelfIntersections, SoundBodiesHaveNone) {
  EXPECT_EQ(pairs(make_box({0, 0, 0}, {3, 2, 1}, 5)), 0u);
  EXPECT_EQ(pairs(make_sphere({1e6, 0, 0}, 3, 4)), 0u);
  TriangleMesh touching = make_box({0, 0, 0}, {1, 1, 1});
  append(touching, make_box({1, 1, 1}, {2, 2, 2}));
  EXPECT_EQ(pairs(touching), 0u) << "a common corner is shared, not an intersection";
}

TEST(FindSelfIntersections, KnowsEveryKindOfMeeting) {
  const std::array<Vec3, 3> t{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  EXPECT_EQ(pairs(two(t, {{{1, 1, -1}, {1, 1, 1}, {9, 9, 0}}})), 1u) << "through the middle";
  EXPECT_EQ(pairs(two(t, {{{1, 1, 0}, {1, 1, 1}, {9, 9, 5}}})), 1u) << "touching with a corner";
  EXPECT_EQ(pairs(two(t, {{{1, 1, 1e-300}, {1, 1, 1}, {9, 9, 5}}})), 0u) << "a hair away";
  EXPECT_EQ(pairs(two(t, {{{1, 1, 0}, {9, 1, 0}, {1, 9, 0}}})), 1u) << "in one plane";
  EXPECT_EQ(pairs(two(t, {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}}})), 1u) << "folded at an edge";
  EXPECT_EQ(pairs(two(t, {{{0, 0, 0}, {4, 0, 0}, {1, 1, 1e-9}}})), 0u) << "sharing an edge";
  EXPECT_EQ(pairs(two(t, {{{4, 0, 0}, {0, 0, 0}, {1, -1, 0}}})), 0u) << "flat across an edge";
  EXPECT_EQ(pairs(two(t, {{{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}})), 1u) << "through, from a corner";
  EXPECT_EQ(pairs(two(t, {{{0, 0, 0}, {-1, 1, 1}, {-1, 1, -1}}})), 0u) << "sharing a corner";
  EXPECT_EQ(pairs(two(t, t)), 1u) << "the same twice";
  EXPECT_EQ(pairs(two(t, {{{1, 1, -1}, {1, 1, 0}, {1, 1, 1}}})), 0u) << "no area: left out";
}

TEST(FindSelfIntersections, FindsWhatAComparisonOfAllPairsFinds) {
  // Two spheres in each other: compare with every pair asked for alone.
  TriangleMesh mesh = make_sphere({0, 0, 0}, 3, 1);
  append(mesh, make_sphere({2, 0.5, 0.25}, 3, 1));
  const SelfIntersections all = find_self_intersections(mesh);
  std::size_t count = 0;
  for (std::uint32_t s = 0; s < mesh.triangles.size(); ++s) {
    for (std::uint32_t t = s + 1; t < mesh.triangles.size(); ++t) {
      count += pairs(two(corners(mesh, s), corners(mesh, t)));
    }
  }
  EXPECT_GT(count, 20u);
  EXPECT_EQ(all.pairs.size(), count);
  EXPECT_TRUE(all.complete);
  EXPECT_TRUE(std::ranges::is_sorted(all.pairs));
  EXPECT_NEAR(length(all.first_nm), 3, 1) << "on the circle where they cross";
}

TEST(FindSelfIntersections, TheLimitAndThreadsKeepTheFirstPairs) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 3, 4);
  append(mesh, make_sphere({2, 0.5, 0.25}, 3, 4));
  const SelfIntersections all = find_self_intersections(mesh, {.threads = 1});
  EXPECT_EQ(find_self_intersections(mesh, {.threads = 3}).pairs, all.pairs);
  const SelfIntersections few = find_self_intersections(mesh, {.limit = 7});
  ASSERT_EQ(few.pairs.size(), 7u);
  EXPECT_FALSE(few.complete);
  EXPECT_TRUE(std::equal(few.pairs.begin(), few.pairs.end(), all.pairs.begin()));
}

TEST(FindSelfIntersections, RefusesBadArguments) {
  EXPECT_THROW(find_self_intersections(make_sphere({}, 1, 1), {.limit = 0}), UsageError);
  EXPECT_THROW(find_self_intersections({}), InvalidInput);
}

}  // namespace surf
