// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/simplify_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;

TriangleMesh rough_body() { return height_field_solid(make_rough({60, 40, 1}, 4, 12, 3), -40); }

}  // namespace

TEST(MeshDeviation, KnowsConcentricSpheres) {
  const MeshDeviation d = mesh_deviation(make_sphere({}, 10, 5), make_sphere({}, 11, 5));
  EXPECT_NEAR(d.from_first_nm, 1, 0.01);
  EXPECT_NEAR(d.from_second_nm, 1, 0.01);
  EXPECT_LT(mesh_deviation(make_sphere({}, 10, 3), make_sphere({}, 10, 3)).largest_nm(), 1e-13);
}

TEST(MeshDeviation, HasTwoSides) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  TriangleMesh two = box;
  append(two, make_box({5, 0, 0}, {6, 1, 1}));
  const MeshDeviation d = mesh_deviation(box, two);
  EXPECT_EQ(d.from_first_nm, 0);
  EXPECT_DOUBLE_EQ(d.from_second_nm, 5);
  EXPECT_DOUBLE_EQ(d.largest_nm(), 5);
}

TEST(MeshDeviation, SeesBetweenTheCorners) {
  // A roof over a square: the ridge is 1 above the square's middle, where it has no corner.
  const TriangleMesh flat{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const TriangleMesh roof{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 1}},
                          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  const MeshDeviation d = mesh_deviation(flat, roof, {.spacing_nm = 0.05});
  EXPECT_DOUBLE_EQ(d.from_second_nm, 1);
  EXPECT_NEAR(d.from_first_nm, 2 / std::sqrt(5.0), 0.03);
  EXPECT_EQ(mesh_deviation(flat, roof, {.spacing_nm = 0.05, .threads = 3}).from_first_nm,
            d.from_first_nm);
  EXPECT_THROW(mesh_deviation(flat, roof, {.spacing_nm = -1}), UsageError);
  EXPECT_THROW(mesh_deviation(flat, {}), InvalidInput);
}

TEST(SimplifyMesh, KeepsWithinTheTolerance) {
  const TriangleMesh body = rough_body();
  std::size_t previous = body.triangles.size();
  for (const double tolerance : {0.05, 0.2, 1.0}) {
    const auto [simple, s] = simplify_mesh(body, {.tolerance_nm = tolerance});
    EXPECT_LE(s.deviation.largest_nm(), tolerance);
    EXPECT_LE(mesh_deviation(body, simple, {.spacing_nm = 0.3}).largest_nm(), 1.1 * tolerance)
        << "measured more densely";
    EXPECT_LT(s.triangles_after, previous) << "a wider tolerance takes fewer triangles";
    previous = s.triangles_after;
    const MeshReport r = check_mesh(simple);
    EXPECT_TRUE(r.closed_and_oriented);
    EXPECT_EQ(r.components, 1u);
    EXPECT_EQ(r.degenerate_triangles + r.duplicate_triangles, 0u);
    EXPECT_EQ(r.triangles, s.triangles_after);
  }
  EXPECT_LT(previous, body.triangles.size() / 4);
}

TEST(SimplifyMesh, LosesNothingOfABox) {
  const TriangleMesh box = make_box({1e5, 0, 0}, {1e5 + 3, 2, 1}, 12);
  const auto [simple, s] = simplify_mesh(box, {.tolerance_nm = 1e-6});
  EXPECT_EQ(simple.triangles.size(), 12u);
  EXPECT_NEAR(check_mesh(simple).signed_volume_nm3, 6, 1e-9);
  for (const Vec3& v : simple.vertices_nm) {
    EXPECT_TRUE(std::ranges::find(box.vertices_nm, v) != box.vertices_nm.end());
  }
}

TEST(SimplifyMesh, EndsAtANumberOfTriangles) {
  const TriangleMesh sphere = make_sphere({}, 10, 5);
  const auto [simple, s] = simplify_mesh(sphere, {.triangles = 500});
  EXPECT_LE(simple.triangles.size(), 500u);
  EXPECT_GE(simple.triangles.size(), 490u);
  EXPECT_TRUE(s.reached);
  EXPECT_TRUE(check_mesh(simple).closed_and_oriented);
  EXPECT_LT(s.deviation.largest_nm(), 0.5);
  EXPECT_GT(s.deviation.largest_nm(), 0);

  const SimplifySummary few = simplify_mesh(sphere, {.tolerance_nm = 0.01, .triangles = 4}).summary;
  EXPECT_FALSE(few.reached);
  EXPECT_LE(few.deviation.largest_nm(), 0.01);
}

TEST(SimplifyMesh, KeepsWhatHangsTogetherAtNonManifoldEdges) {
  TriangleMesh mesh = make_box({0, 0, 0}, {1, 1, 1}, 6);
  append(mesh, make_box({1, 1, 0}, {2, 2, 1}, 6));
  ASSERT_EQ(check_mesh(mesh).nonmanifold_edges, 6u);
  const auto [simple, s] = simplify_mesh(mesh, {.tolerance_nm = 1e-6});
  const MeshReport r = check_mesh(simple);
  EXPECT_EQ(r.nonmanifold_edges, 6u);
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_NEAR(r.signed_volume_nm3, 2, 1e-12);
  EXPECT_LT(r.triangles, 100u);
}

TEST(SimplifyMesh, KeepsTheRimOfASheet) {
  const TriangleMesh sheet = height_field_sheet(make_rough({60, 40, 1}, 2, 12, 1));
  const auto [simple, s] = simplify_mesh(sheet, {.tolerance_nm = 0.1});
  EXPECT_LT(s.triangles_after, s.triangles_before);
  EXPECT_LE(s.deviation.largest_nm(), 0.1);
  EXPECT_LE(length(bounds(simple).size_nm() - bounds(sheet).size_nm()), 0.2);
}

TEST(SimplifyMesh, RefusesBadArguments) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(simplify_mesh(box, {}), UsageError);
  EXPECT_THROW(simplify_mesh(box, {.tolerance_nm = -1}), UsageError);
  EXPECT_THROW(simplify_mesh({}, {.tolerance_nm = 1}), InvalidInput);
  TriangleMesh line;
  line.vertices_nm = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(simplify_mesh(line, {.tolerance_nm = 1}), InvalidInput);
}

TEST(SimplifyMesh, KeepsFixedVertices) {
  const TriangleMesh ball = make_sphere({1e4, 0, 0}, 20, 4);
  SimplifyOptions options{.tolerance_nm = 1};
  for (const Vec3& v : ball.vertices_nm)
    if (v.z < 0) options.fixed_nm.push_back(v);
  const auto [half, s] = simplify_mesh(ball, options);
  const auto below = [](const TriangleMesh& m) {
    return std::ranges::count_if(m.vertices_nm, [](const Vec3& v) { return v.z < 0; });
  };
  EXPECT_EQ(below(half), below(ball));
  EXPECT_LT(half.triangles.size(), ball.triangles.size() * 2 / 3);
  EXPECT_TRUE(check_mesh(half).closed_and_oriented);
}

}  // namespace surf
