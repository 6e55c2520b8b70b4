// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/vertex_curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

/// A body of four times as many triangles, again and again, on the sphere of that radius.
TriangleMesh sphere(double radius_nm, const Vec3& centre, int times) {
  TriangleMesh mesh{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int i = 0; i < times; ++i) {
    TriangleMesh finer;
    for (const Triangle& t : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(finer.vertices_nm.size());
      for (std::size_t k = 0; k < 3; ++k) finer.vertices_nm.push_back(mesh.vertices_nm[t[k]]);
      for (std::size_t k = 0; k < 3; ++k)
        finer.vertices_nm.push_back(
            normalized(mesh.vertices_nm[t[k]] + mesh.vertices_nm[t[(k + 1) % 3]]));
      for (const Triangle& s : {Triangle{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
        finer.triangles.push_back({first + s[0], first + s[1], first + s[2]});
    }
    mesh = finer;  // vertices are there several times
  }
  transform(mesh, radius_nm, centre);
  return mesh;
}

HeightField field_of(double (*z)(double, double)) {
  HeightField f{{0.5, 0.5, -7.5, -5}, Grid<double>(31, 21)};
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 31; ++x) f.z_nm(x, y) = z(f.x_nm(x), f.y_nm(y));
  return f;
}

}  // namespace

TEST(MeanCurvature, OfASphereIsOneOverItsRadius) {
  for (const double radius : {1e-3, 3.0, 1e6}) {
    for (const float h : mean_curvature(sphere(radius, {5 * radius, 0, -radius}, 4)))
      EXPECT_NEAR(h * radius, 1, 0.03)
          << "the quadric of a sphere, as wide as a third of its radius";
  }
}

TEST(MeanCurvature, ConvergesWithTheMesh) {
  double last = 1;
  for (const int times : {2, 3, 4}) {
    double worst = 0;
    for (const float h : mean_curvature(sphere(2, {}, times)))
      worst = std::max(worst, std::abs(2.0 * h - 1));
    EXPECT_LT(worst, 0.35 * last) << times;
    last = worst;
  }
}

TEST(MeanCurvature, OfAParaboloidIsExactAtItsTop) {
  const HeightField f =
      field_of([](double x, double y) { return -0.02 * x * x - 0.05 * y * y + 0.01 * x * y; });
  const std::vector<float> h = mean_curvature(height_field_sheet(f));
  EXPECT_NEAR(h[10 * 31 + 15], 0.07, 1e-6) << "half the sum of 0.04 and 0.1: a bump is positive";
}

TEST(MeanCurvature, OfPlanesIsZeroToTheRim) {
  const HeightField f = field_of([](double x, double y) { return 0.7 * x - 0.2 * y + 1000; });
  for (const float h : mean_curvature(height_field_sheet(f))) EXPECT_NEAR(h, 0, 1e-6);
}

TEST(MeanCurvature, OfACylinderIsHalfUpToTheRim) {
  const HeightField f = field_of([](double x, double) { return -std::sqrt(400 - x * x); });
  for (const float h : mean_curvature(height_field_sheet(f))) EXPECT_NEAR(h, -1.0 / 40, 0.0005);
}

TEST(MeanCurvature, IsFiniteWhereVerticesAreTooFewOrDegenerate) {
  TriangleMesh few{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}}, {{0, 1, 2}}};
  for (const float h : mean_curvature(few)) EXPECT_NEAR(h, 0, 1e-6);
  few.triangles.push_back({0, 0, 1});
  few.vertices_nm[2] = {2, 0, 0};  // no area at all
  for (const float h : mean_curvature(few)) EXPECT_EQ(h, 0);
  const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  for (const float h : mean_curvature(tetrahedron)) {
    EXPECT_TRUE(std::isfinite(h));
    EXPECT_GT(h, 0);
  }
}

TEST(MeanCurvature, DoesNotLookAtTheOtherSide) {
  HeightField f{{}, Grid<double>(2, 2, 1.0)};
  for (const float h : mean_curvature(height_field_solid(f, 0)))
    EXPECT_GE(h, -1e-6) << "a cube is convex";
  EXPECT_GT(mean_curvature(height_field_solid(f, 0))[0], 0.3);
}

TEST(MeanCurvature, TurnsWithTheMesh) {
  const HeightField f = make_rough({40, 30, 1}, 2, 5, 8);
  TriangleMesh mesh = height_field_sheet(f);
  const std::vector<float> before = mean_curvature(mesh);
  for (Vec3& v : mesh.vertices_nm) v = {v.z + 50, v.x, v.y};  // an even permutation
  const std::vector<float> after = mean_curvature(mesh);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-5);
}

TEST(MeanCurvature, ThreadsDoNotChangeIt) {
  const TriangleMesh mesh = height_field_sheet(make_rough({120, 90, 1}, 2, 5, 8));
  EXPECT_EQ(mean_curvature(mesh, 1), mean_curvature(mesh, 5));
}

TEST(MeanCurvature, RefusesDamagedMeshes) {
  EXPECT_THROW(mean_curvature({{{0, 0, 0}}, {{0, 1, 2}}}), InvalidInput);
}

}  // namespace surf
