// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/check_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;
using testing::HasSubstr;

TriangleMesh unit_cube() { return make_box({0, 0, 0}, {1, 1, 1}); }

/// Counts of a report that speak of defects.
std::vector<std::size_t> defects(const MeshReport& r) {
  return {r.degenerate_triangles, r.duplicate_triangles, r.boundary_edges, r.nonmanifold_edges,
          r.inconsistent_edges};
}

}  // namespace

TEST(CheckMesh, ACubeIsClosed) {
  const MeshReport r = check_mesh(unit_cube());
  EXPECT_EQ(r.vertices, 8u);
  EXPECT_EQ(r.triangles, 12u);
  EXPECT_EQ(r.components, 1u);
  EXPECT_EQ(defects(r), (std::vector<std::size_t>{0, 0, 0, 0, 0}));
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_DOUBLE_EQ(r.area_nm2, 6);
  EXPECT_DOUBLE_EQ(r.signed_volume_nm3, 1);
  EXPECT_EQ(summary(r), "closed, 12 triangles, 8 vertices, 1 component");
}

TEST(CheckMesh, EqualCoordinatesAreOneVertex) {
  TriangleMesh soup;
  for (const Triangle& t : unit_cube().triangles) {
    TriangleMesh one;
    for (const std::uint32_t corner : t) one.vertices_nm.push_back(unit_cube().vertices_nm[corner]);
    one.triangles = {{0, 1, 2}};
    append(soup, one);
  }
  soup.vertices_nm.push_back({5, 5, 5});
  const MeshReport r = check_mesh(soup);
  EXPECT_EQ(r.vertices, 8u) << "unused vertices do not count";
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_EQ(r.components, 1u);
}

TEST(CheckMesh, AMissingTriangleLeavesThreeBoundaryEdges) {
  TriangleMesh mesh = unit_cube();
  const Triangle lost = mesh.triangles.back();
  mesh.triangles.pop_back();
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(defects(r), (std::vector<std::size_t>{0, 0, 3, 0, 0}));
  EXPECT_FALSE(r.closed_and_oriented);
  std::vector<Vec3> middles;
  for (std::size_t k = 0; k < 3; ++k) {
    middles.push_back((mesh.vertices_nm[lost[k]] + mesh.vertices_nm[lost[(k + 1) % 3]]) * 0.5);
  }
  EXPECT_THAT(middles, testing::Contains(r.first_boundary_nm));
  EXPECT_THAT(summary(r), HasSubstr("open: 3 boundary edges near ("));
}

TEST(CheckMesh, ATurnedTriangleHasThreeInconsistentEdges) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 1, 2);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(defects(r), (std::vector<std::size_t>{0, 0, 0, 0, 3}));
  EXPECT_FALSE(r.closed_and_oriented);
  EXPECT_THAT(summary(r), HasSubstr("turned against each other at 3 edges"));
}

TEST(CheckMesh, InsideOutIsClosedWithNegativeVolume) {
  TriangleMesh mesh = unit_cube();
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_DOUBLE_EQ(r.signed_volume_nm3, -1);
  EXPECT_THAT(summary(r), HasSubstr("closed, normals inward"));
}

TEST(CheckMesh, CubesThatTouchAlongAnEdgeBalance) {
  TriangleMesh mesh = unit_cube();
  append(mesh, make_box({1, 1, 0}, {2, 2, 1}));
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_edges, 1u);
  EXPECT_EQ(r.first_nonmanifold_nm, (Vec3{1, 1, 0.5}));
  EXPECT_EQ(r.components, 1u);
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_THAT(summary(r), HasSubstr("more than two triangles at 1 edge near (1, 1, 0.5) nm"));
}

TEST(CheckMesh, AFinOnACubeDoesNotBalance) {
  TriangleMesh mesh = unit_cube();
  append(mesh, {{{0, 0, 0}, {0, 0, 1}, {-1, -1, 0}}, {{0, 1, 2}}});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(defects(r), (std::vector<std::size_t>{0, 0, 2, 1, 0}));
  EXPECT_FALSE(r.closed_and_oriented);
}

TEST(CheckMesh, DuplicatesCountInAnyOrderOfCorners) {
  TriangleMesh mesh = unit_cube();
  const auto [a, b, c] = mesh.triangles[0];
  mesh.triangles.push_back({b, c, a});
  mesh.triangles.push_back({b, a, c});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.duplicate_triangles, 2u);
  EXPECT_EQ(r.nonmanifold_edges, 3u);
  EXPECT_TRUE(r.closed_and_oriented) << "the two copies run against each other";
}

TEST(CheckMesh, DegenerateTriangles) {
  TriangleMesh mesh = unit_cube();
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_EQ(check_mesh(mesh).degenerate_triangles, 1u);
  EXPECT_TRUE(check_mesh(mesh).closed_and_oriented) << "a repeated corner bounds nothing";
  append(mesh, {{{7, 7, 7}, {7.25, 7.5, 7.75}, {7.5, 8, 8.5}}, {{0, 1, 2}}});
  EXPECT_EQ(check_mesh(mesh).degenerate_triangles, 2u) << "corners on a line";
  EXPECT_EQ(check_mesh(mesh).boundary_edges, 3u);
}

TEST(CheckMesh, ThinTrianglesAreNotDegenerate) {
  const TriangleMesh sliver{{{0, 0, 0}, {1e6, 0, 0}, {5e5, 1e-6, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(check_mesh(sliver).degenerate_triangles, 0u);
}

TEST(CheckMesh, ComponentsMeetInSharedVertices) {
  TriangleMesh mesh = unit_cube();
  append(mesh, make_box({1, 1, 1}, {2, 2, 2}));
  EXPECT_EQ(check_mesh(mesh).components, 1u);
  append(mesh, make_box({3, 3, 3}, {4, 4, 4}));
  append(mesh, make_sphere({9, 9, 9}, 1, 1));
  EXPECT_EQ(check_mesh(mesh).components, 3u);
}

TEST(CheckMesh, CountsPointsWhereFansTouch) {
  TriangleMesh mesh = unit_cube();
  EXPECT_EQ(check_mesh(mesh).nonmanifold_vertices, 0u);
  append(mesh, make_box({1, 1, 1}, {2, 2, 2}));
  MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_vertices, 1u);
  EXPECT_EQ(r.first_nonmanifold_vertex_nm, (Vec3{1, 1, 1}));
  EXPECT_THAT(summary(r), HasSubstr("parts that touch in a point at 1 vertex near (1, 1, 1) nm"));
  append(mesh, make_box({-1, -1, -1}, {0, 0, 0}));
  r = check_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_vertices, 2u);
  EXPECT_EQ(r.nonmanifold_edges, 0u);
  EXPECT_TRUE(r.closed_and_oriented);
}

TEST(CheckMesh, CountsDirectedEdgesThatAreUsedTwice) {
  TriangleMesh mesh = unit_cube();
  EXPECT_EQ(check_mesh(mesh).doubled_directed_edges, 0u);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_EQ(check_mesh(mesh).doubled_directed_edges, 3u);
  mesh = unit_cube();
  append(mesh, unit_cube());
  EXPECT_EQ(check_mesh(mesh).doubled_directed_edges, 36u) << "both ways of 18 edges";
  EXPECT_EQ(check_mesh(mesh).inconsistent_edges, 0u);
}

TEST(CheckMesh, SaysWhereFacesAreFaulty) {
  TriangleMesh mesh = make_box({0, 0, 0}, {3, 3, 3});
  EXPECT_TRUE(faults(check_mesh(mesh)).empty());
  append(mesh, {{{7, 7, 7}, {8, 8, 8}, {9, 9, 9}}, {{0, 1, 2}}});
  mesh.triangles.push_back(mesh.triangles[0]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.first_degenerate_nm, (Vec3{8, 8, 8}));
  const Triangle t = mesh.triangles[0];
  const Vec3 middle =
      (mesh.vertices_nm[t[0]] + mesh.vertices_nm[t[1]] + mesh.vertices_nm[t[2]]) * (1.0 / 3);
  EXPECT_EQ(r.first_duplicate_nm, middle);
  EXPECT_THAT(faults(r), testing::Contains("1 degenerate triangle near (8, 8, 8) nm"));
}

TEST(CheckMesh, VolumeSurvivesFarFromTheOrigin) {
  // Coordinates of few binary digits, so that moving them rounds nothing.
  TriangleMesh mesh = make_sphere({0, 0, 0}, 5, 3);
  for (Vec3& v : mesh.vertices_nm) {
    v = {std::ldexp(std::round(std::ldexp(v.x, 20)), -20),
         std::ldexp(std::round(std::ldexp(v.y, 20)), -20),
         std::ldexp(std::round(std::ldexp(v.z, 20)), -20)};
  }
  const double volume = check_mesh(mesh).signed_volume_nm3;
  transform(mesh, 1, {0x1p30, -0x1p30, 0x1p29});
  EXPECT_NEAR(check_mesh(mesh).signed_volume_nm3, volume, 1e-10 * volume);
}

TEST(CheckMesh, AnEmptyMeshIsNotClosed) {
  const MeshReport r = check_mesh({});
  EXPECT_FALSE(r.closed_and_oriented);
  EXPECT_EQ(summary(r), "0 triangles, 0 vertices, 0 components");
}

TEST(CheckMesh, RefusesDamagedMeshes) {
  TriangleMesh mesh = unit_cube();
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(check_mesh(mesh), InvalidInput);
  EXPECT_THROW(triangle_components(mesh), InvalidInput);
  mesh = unit_cube();
  mesh.vertices_nm[3].x = NAN;
  EXPECT_THROW(check_mesh(mesh), InvalidInput);
}

TEST(TriangleComponents, AreNumberedByFirstAppearance) {
  TriangleMesh mesh = make_box({3, 3, 3}, {4, 4, 4});
  append(mesh, unit_cube());
  std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 18, mesh.triangles.end());
  std::vector<std::uint32_t> expected(24, 0);
  std::fill(expected.begin() + 6, expected.begin() + 18, 1);
  EXPECT_EQ(triangle_components(mesh), expected);
  EXPECT_TRUE(triangle_components({}).empty());
}

}  // namespace surf
