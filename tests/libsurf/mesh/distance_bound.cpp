// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/distance_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;

/// The largest distance of points of `from`, in a fine grid on each triangle, from all triangles of
/// `to`, without a tree.
double brute_force(const TriangleMesh& from, const TriangleMesh& to, int steps) {
  double largest = 0;
  for (const auto& [a, b, c] : from.triangles) {
    const auto& v = from.vertices_nm;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3 p =
            v[a] + (v[b] - v[a]) * (double(i) / steps) + (v[c] - v[a]) * (double(j) / steps);
        double least = HUGE_VAL;
        for (const auto& [d, e, f] : to.triangles)
          least = std::min(least, length(closest_point(to.vertices_nm[d], to.vertices_nm[e],
                                                       to.vertices_nm[f], p) -
                                         p));
        largest = std::max(largest, least);
      }
  }
  return largest;
}

/// Both bounds lie between what a brute force finds and a little more.
void expect_bounds(const char* name, const TriangleMesh& a, const TriangleMesh& b, int steps,
                   double step_nm) {
  const DistanceBound bound = bound_distance(a, b);
  EXPECT_TRUE(bound.proven()) << name;
  const auto check = [&](double bound_nm, double found_nm) {
    EXPECT_GE(bound_nm, found_nm) << name;
    EXPECT_LE(bound_nm, 1.0101 * (found_nm + step_nm) + 1e-8) << name;
  };
  check(bound.from_first_nm, brute_force(a, b, steps));
  check(bound.from_second_nm, brute_force(b, a, steps));
}

TriangleMesh strip(const std::vector<std::pair<double, double>>& section, double width) {
  TriangleMesh m;
  for (const auto& [x, z] : section) {
    m.vertices_nm.push_back({x, 0, z});
    m.vertices_nm.push_back({x, width, z});
  }
  for (std::uint32_t i = 0; i + 3 < m.vertices_nm.size(); i += 2) {
    m.triangles.push_back({i, i + 2, i + 1});
    m.triangles.push_back({i + 1, i + 2, i + 3});
  }
  return m;
}

TriangleMesh soup(int triangles, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return double(random() >> 11) / double(1ull << 53); };
  TriangleMesh m;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 at{uniform(), uniform(), uniform()};
    const auto n = static_cast<std::uint32_t>(m.vertices_nm.size());
    for (int k = 0; k < 3; ++k)
      m.vertices_nm.push_back(at + Vec3{uniform() - 0.5, uniform() - 0.5, uniform() - 0.5} * size);
    m.triangles.push_back({n, n + 1, n + 2});
  }
  return m;
}

}  // namespace

TEST(DistanceBound, IsNeverBelowABruteForce) {
  const TriangleMesh flat = strip({{0, 0}, {4, 0}}, 4);
  // A spike between the corners of the other surface.
  TriangleMesh spike = flat;
  spike.vertices_nm.push_back({1.3, 1.1, 2.7});
  spike.triangles[0] = {0, 2, 4};
  spike.triangles.insert(spike.triangles.end(), {{2, 1, 4}, {1, 0, 4}});
  expect_bounds("spike", flat, spike, 60, 0.1);
  expect_bounds("folded sheet", flat,
                strip({{0, 0}, {3, 0}, {3.02, 0.01}, {1, 0.02}, {1.01, 0.3}, {4, 0.1}}, 4), 40,
                0.15);
  expect_bounds("thin fin", flat, strip({{0, 0}, {2, 0}, {2.001, 1}, {2.002, 0}, {4, 0}}, 4), 60,
                0.1);
  TriangleMesh coincident = flat;
  append(coincident, test::turned(strip({{0, 0}, {1.7, 0}, {4, 0}}, 4)));
  expect_bounds("coincident sheets", flat, coincident, 20, 1e-8);
  expect_bounds("slivers", flat,
                strip({{0, 0}, {1e-7, 0}, {2e-7, 0.1}, {3.999999, 0.1}, {4, 0}}, 4), 60, 0.1);
  TriangleMesh needles;
  for (std::uint32_t i = 0; i < 40; ++i) {
    needles.vertices_nm.insert(needles.vertices_nm.end(),
                               {{0, 0.1 * i, 0}, {4, 0.1 * i + 1e-9, 0.01}, {4, 0.1 * i + 0.1, 0}});
    needles.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  expect_bounds("needles", flat, needles, 40, 0.15);
  const TriangleMesh line{{{0, 0, 1}, {1, 0, 1}, {3, 0, 1}}, {{0, 1, 2}}};
  expect_bounds("a triangle without area", flat, line, 100, 0.08);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_bounds("scattered", soup(12, 0.8, seed), soup(15, 0.8, 100 + seed), 40, 0.04);
    expect_bounds("scattered slivers", soup(6, 1.5, seed), soup(40, 0.1, 200 + seed), 40, 0.08);
  }
}

TEST(DistanceBound, IsTightWithinItsAccuracy) {
  // A roof over a square: the ridge's middle is 1 above it; the square's middle is nearest to four
  // slopes at once.
  const TriangleMesh flat{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const TriangleMesh roof{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 1}},
                          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  for (const double accuracy : {0.1, 0.01, 1e-4}) {
    const DistanceBound d = bound_distance(flat, roof, {.accuracy = accuracy});
    EXPECT_GE(d.from_first_nm, 2 / std::sqrt(5.0));
    EXPECT_LE(d.from_first_nm, (1 + 1.01 * accuracy) * 2 / std::sqrt(5.0));
    EXPECT_GE(d.from_second_nm, 1);
    EXPECT_LE(d.from_second_nm, 1 + 1.01 * accuracy);
  }
  // A spike of any height is seen to the last digit.
  TriangleMesh spike = make_box({0, 0, 0}, {9, 9, 9}, 9);
  for (Vec3& v : spike.vertices_nm)
    if (v == Vec3{4, 4, 9}) v.z = 12;
  const DistanceBound d = bound_distance(make_box({0, 0, 0}, {9, 9, 9}), spike);
  EXPECT_GE(d.from_second_nm, 3);
  EXPECT_LE(d.from_second_nm, 3.0301);
}

TEST(DistanceBound, AllowsForRounding) {
  // Far from the origin, and sheets at a distance that no binary number is. Long triangles, cut
  // often.
  for (const double far : {0.0, 1e3, 1e6, 1e9}) {
    const double above = far + 0.1;
    TriangleMesh fine = height_field_sheet(make_rough({20, 20, 1}, 1, 10, 1));
    for (Vec3& v : fine.vertices_nm) v = {v.x + far, v.y + far / 3, above};
    TriangleMesh coarse{{{-99 + far, -99 + far / 3, far},
                         {199 + far, -99 + far / 3, far},
                         {far, 199 + far / 3, far}},
                        {{0, 1, 2}}};
    const double apart = above - far;  // exact: the two are near each other
    const DistanceBound d = bound_distance(fine, coarse);
    EXPECT_GE(d.from_first_nm, apart);
    EXPECT_LE(d.from_first_nm, 1.0101 * apart + 1e-9 * far);
    EXPECT_LE(bound_distance(fine, fine).largest_nm(), 1e-12);
  }
}

TEST(DistanceBound, IsZeroUpToRoundingForOneSurfaceInOtherTriangles) {
  EXPECT_LE(bound_distance(make_box({0, 0, 0}, {3, 2, 1}, 12), make_box({0, 0, 0}, {3, 2, 1}, 5))
                .largest_nm(),
            1e-9);
  EXPECT_LE(bound_distance(make_box({0, 0, 0}, {3, 2, 1}, 40), make_box({0, 0, 0}, {3, 2, 1}))
                .largest_nm(),
            1e-9);
}

TEST(DistanceBound, DoesNotDependOnThreads) {
  const TriangleMesh a = height_field_solid(make_rough({60, 60, 1}, 2, 8, 1), -40);
  const TriangleMesh b = height_field_solid(make_rough({60, 60, 1.5}, 2, 8, 1), -40);
  const DistanceBound one = bound_distance(a, b, {.threads = 1});
  for (const int threads : {2, 5}) {
    const DistanceBound more = bound_distance(a, b, {.threads = threads});
    EXPECT_EQ(more.from_first_nm, one.from_first_nm);
    EXPECT_EQ(more.from_second_nm, one.from_second_nm);
  }
}

TEST(DistanceBound, SaysWhatIsNotProvenAndRefusesBadArguments) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(bound_distance(box, box).proven());
  const TriangleMesh huge = make_box({0, 0, 0}, {1e200, 1e200, 1e200});
  EXPECT_FALSE(bound_distance(huge, make_box({0, 0, 0}, {1e200, 2e200, 1e200})).proven());
  EXPECT_THROW(bound_distance(box, box, {.accuracy = 0}), UsageError);
  EXPECT_THROW(bound_distance(box, {}), InvalidInput);
}

}  // namespace surf
