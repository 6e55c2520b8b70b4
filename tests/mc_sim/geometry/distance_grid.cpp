// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/distance_grid.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "random_direction.h"
#include "statistics.h"
#include "surf/core/random.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double run = dot(ab, ab);
  const double t = run > 0 ? std::clamp(dot(p - a, ab) / run, 0.0, 1.0) : 0;
  return length(p - a - ab * t);
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double to_edges = std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const Vec3 across = cross(b - a, c - a);
  if (!(length(across) > 0)) return to_edges;
  const Vec3 n = normalized(across);
  const auto left_of = [&](const Vec3& u, const Vec3& v) {
    return dot(cross(v - u, p - u), n) >= 0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::fabs(dot(p - a, n));
  return to_edges;
}

double distance(const TriangleMesh& mesh, const Vec3& p) {
  double best = HUGE_VAL;
  for (const Triangle& t : mesh.triangles)
    best = std::min(best, distance_to_triangle(p, mesh.vertices_nm[t[0]], mesh.vertices_nm[t[1]],
                                               mesh.vertices_nm[t[2]]));
  return best;
}

using test::isotropic;

// A point up to `away` from a random triangle.
Vec3 near_surface(const TriangleMesh& mesh, double away, RandomStream& random) {
  const auto count = static_cast<double>(mesh.triangles.size());
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(random.uniform() * count)];
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vec3& a = mesh.vertices_nm[t[0]];
  return a + (mesh.vertices_nm[t[1]] - a) * u + (mesh.vertices_nm[t[2]] - a) * v +
         isotropic(random) * (away * random.uniform());
}

struct Shortfall {
  double mean_nm = 0;  // within 3 nm of the surface
  double mean_far_nm = 0;
};

// The proof by trial: no bound exceeds the true distance, near the surface and all over the domain.
Shortfall expect_bounds(const TriangleMesh& mesh, const Box& domain, std::size_t bytes,
                        int points) {
  const DistanceGrid field(mesh, domain, bytes);
  RandomStream random(1, bytes, mesh.triangles.size());
  const Vec3 size = domain.size_nm(), margin = size * 0.2;
  Shortfall out;
  int near = 0, far = 0;
  for (int i = 0; i < points; ++i) {
    const Vec3 p =
        i % 2 == 0
            ? near_surface(mesh, 4, random)
            : Vec3{domain.lower_nm.x - margin.x + (size.x + 2 * margin.x) * random.uniform(),
                   domain.lower_nm.y - margin.y + (size.y + 2 * margin.y) * random.uniform(),
                   domain.lower_nm.z - margin.z + (size.z + 2 * margin.z) * random.uniform()};
    const double d = distance(mesh, p), bound = field.bound_nm(p);
    EXPECT_GE(bound, 0);
    EXPECT_LE(bound, d) << p.x << " " << p.y << " " << p.z;
    if (testing::Test::HasFailure()) return out;
    (d < 3 ? near : far)++;
    (d < 3 ? out.mean_nm : out.mean_far_nm) += d - bound;
  }
  out.mean_nm /= std::max(near, 1);
  out.mean_far_nm /= std::max(far, 1);
  return out;
}

constexpr std::size_t memory = 8 << 20;

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  transform(mesh, 1, by);
  return mesh;
}

}  // namespace

TEST(DistanceGrid, IsNeverMoreThanTheDistance) {
  const TriangleMesh box = make_box({-50, -40, -30}, {50, 40, 30});
  EXPECT_LT(expect_bounds(box, bounds(box), memory, 200000).mean_nm, 0.1);
  const TriangleMesh ball = make_sphere({100, 0, -7}, 25, 3);
  const Shortfall of_ball = expect_bounds(ball, bounds(ball), memory, 40000);
  EXPECT_LT(of_ball.mean_nm, 0.4);
  EXPECT_LT(of_ball.mean_far_nm, 4);
  expect_bounds(ball, bounds(ball), 1 << 16, 4000);
  const TriangleMesh membrane = make_box({-50, -50, -0.5}, {50, 50, 0.5});
  EXPECT_LT(expect_bounds(membrane, bounds(membrane), memory, 100000).mean_nm, 0.2);
}

TEST(DistanceGrid, IsTightNextToAFlatFacet) {
  const TriangleMesh box = make_box({-50, -50, -50}, {50, 50, 50}, 4);
  const DistanceGrid field(box, bounds(box), memory);
  RandomStream random(2, 0, 0);
  double lost = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    // Well off the edges.
    const double depth = 3 * random.uniform();
    const Vec3 p{80 * (random.uniform() - 0.5), 80 * (random.uniform() - 0.5), 50 - depth};
    ASSERT_LE(field.bound_nm(p), depth);
    lost += depth - field.bound_nm(p);
  }
  EXPECT_LT(lost / n, 0.05);
}

TEST(DistanceGrid, HoldsForRoughSurfacesAndAllowsForWhatLiesOutsideItsDomain) {
  const TriangleMesh sheet = half_space_top(make_mesa({120, 120, 6}, 60, 30, 10), 1000);
  Box domain;
  domain.extend(Vec3{-30, -30, 0});
  domain.extend(Vec3{30, 30, 60});
  EXPECT_LT(expect_bounds(sheet, domain, memory, 20000).mean_nm, 0.5);
  const HeightField rough = make_rough({60, 60, 2}, 4, 12, 1);
  const TriangleMesh top = half_space_top(rough, 1000);
  EXPECT_LT(expect_bounds(top, bounds(height_field_sheet(rough)), memory, 10000).mean_nm, 0.5);
}

TEST(DistanceGrid, HoldsFarFromTheOrigin) {
  const Vec3 away{1e5, -1e5, 1e5};
  const TriangleMesh ball = moved(make_sphere({0, 0, 0}, 25, 3), away);
  EXPECT_LT(expect_bounds(ball, bounds(ball), memory, 20000).mean_nm, 0.4);
  const TriangleMesh box = moved(make_box({-30, -30, -30}, {30, 30, 30}), away);
  EXPECT_LT(expect_bounds(box, bounds(box), memory, 40000).mean_nm, 0.1);
}

TEST(DistanceGrid, HoldsForTrianglesSmallerThanItsCellsAmongLargeOnes) {
  TriangleMesh mesh = make_sphere({3, 2, 20}, 7, 4);  // sides of half a nanometre
  const TriangleMesh box = make_box({-60, -60, -20}, {60, 60, 10});
  const auto base = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), box.vertices_nm.begin(), box.vertices_nm.end());
  for (const Triangle& t : box.triangles)
    mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  const Shortfall of_fine = expect_bounds(mesh, bounds(mesh), memory, 5000);
  EXPECT_LT(of_fine.mean_nm, 0.5);
  expect_bounds(mesh, bounds(mesh), 1 << 18, 2000);
  const TriangleMesh coarse = make_sphere({0, 0, 0}, 40, 3);  // sides of 5 nm in cells of about 9
  expect_bounds(coarse, bounds(coarse), 1 << 16, 5000);
}

TEST(DistanceGrid, HoldsForNeedlesAndTrianglesWithoutArea) {
  TriangleMesh mesh;
  RandomStream random(3, 0, 0);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3 a = isotropic(random) * 30.0, along = isotropic(random) * 40.0;
    const double width = i % 3 == 0 ? 0 : i % 3 == 1 ? 1e-7 : 1e-3;
    mesh.vertices_nm.insert(
        mesh.vertices_nm.end(),
        {a, a + along, a + along * random.uniform() + isotropic(random) * width});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_LT(expect_bounds(mesh, bounds(mesh), memory, 100000).mean_nm, 0.5);
}

TEST(DistanceGrid, HoldsForADragonfly) {
  const char* const folder = std::getenv("SEMSURF_TEST_DATA");
  if (!folder || !std::filesystem::exists(folder))
    GTEST_SKIP() << "SEMSURF_TEST_DATA names no folder: real files are not tested";
  TriangleMesh mesh = io::read_mesh(std::filesystem::path(folder) / "mesh" / "dragonfly.obj");
  const Vec3 size = bounds(mesh).size_nm();
  transform(mesh, 100 / std::max({size.x, size.y, size.z}), {});
  EXPECT_LT(expect_bounds(mesh, bounds(mesh), memory, 10000).mean_nm, 0.7);
}

TEST(DistanceGrid, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh ball = make_sphere({0, 0, 0}, 25, 3);
  const DistanceGrid one(ball, bounds(ball), memory, 1), three(ball, bounds(ball), memory, 3);
  EXPECT_EQ(one.bytes(), three.bytes());
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = near_surface(ball, 5, random);
    ASSERT_EQ(one.bound_nm(p), three.bound_nm(p));
  }
}

TEST(DistanceGrid, KeepsToItsMemory) {
  const TriangleMesh top = half_space_top(make_rough({100, 100, 2}, 8, 25, 1), 1000);
  for (const std::size_t bytes : {1u << 16, 1u << 20, 1u << 22})
    EXPECT_LT(DistanceGrid(top, bounds(top), bytes).bytes(), 1.5 * static_cast<double>(bytes));
}

TEST(DistanceGrid, WithoutMemoryBoundsOnlyOutsideTheBox) {
  const TriangleMesh box = make_box({-50, -50, -50}, {50, 50, 50});
  const DistanceGrid field(box, bounds(box), 0);
  EXPECT_EQ(field.bound_nm({0, 0, 0}), 0);
  EXPECT_NEAR(field.bound_nm({0, 0, 80}), 30, 0.01);
}

}  // namespace surf::mc
