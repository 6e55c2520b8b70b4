// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/triangle_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using testing::HasSubstr;

TriangleMesh one_triangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, {{0, 1, 2}}}; }

std::string complaint(const TriangleMesh& mesh) {
  try {
    validate(mesh, "part.stl");
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.subject(), "part.stl");
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

/// Every triangle with its own three vertices, as in an STL file.
TriangleMesh exploded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices_nm.size());
    for (const std::uint32_t corner : t) soup.vertices_nm.push_back(mesh.vertices_nm[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace

TEST(Bounds, HoldAllVertices) {
  const Box box = bounds(one_triangle());
  EXPECT_EQ(box.lower_nm, (Vec3{0, 0, 0}));
  EXPECT_EQ(box.upper_nm, (Vec3{1, 2, 0}));
  EXPECT_TRUE(bounds(TriangleMesh{}).empty());
}

TEST(Transform, ScalesThenMoves) {
  TriangleMesh mesh = one_triangle();
  transform(mesh, 10, {1, 2, 3});
  EXPECT_EQ(mesh.vertices_nm[1], (Vec3{11, 2, 3}));
  EXPECT_EQ(mesh.vertices_nm[2], (Vec3{1, 22, 3}));
}

TEST(Transform, RefusesFactorsThatMirrorOrCollapse) {
  TriangleMesh mesh = one_triangle();
  for (const double factor : {0.0, -1.0, static_cast<double>(NAN), HUGE_VAL}) {
    EXPECT_THROW(transform(mesh, factor, {}), UsageError);
  }
  EXPECT_THROW(transform(mesh, 1, {0, NAN, 0}), UsageError);
  EXPECT_EQ(mesh.vertices_nm, one_triangle().vertices_nm);
}

TEST(MergeEqualVertices, UndoesAnExplodedMesh) {
  const TriangleMesh box = make_box({-1, -2, -3}, {1, 2, 3}, 5);
  const TriangleMesh merged = merge_equal_vertices(exploded(box));
  EXPECT_EQ(merged.vertices_nm.size(), box.vertices_nm.size());
  EXPECT_EQ(exploded(merged).vertices_nm, exploded(box).vertices_nm);
}

TEST(MergeEqualVertices, KeepsOrderAndDropsUnused) {
  const TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {8, 8, 8}},
                          {{4, 3, 2}, {1, 2, 4}}};
  const TriangleMesh merged = merge_equal_vertices(mesh);
  EXPECT_EQ(merged.vertices_nm, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(merged.triangles, (std::vector<Triangle>{{2, 0, 1}, {0, 1, 2}}));
}

TEST(MergeEqualVertices, ZeroHasNoSignAndNearIsNotEqual) {
  const TriangleMesh mesh{{{0.0, 1, 0}, {-0.0, 1, 0}, {1e-300, 1, 0}, {0.0, 1, -0.0}},
                          {{0, 1, 2}, {3, 2, 1}}};
  const TriangleMesh merged = merge_equal_vertices(mesh);
  EXPECT_EQ(merged.vertices_nm.size(), 2u);
  EXPECT_EQ(merged.triangles, (std::vector<Triangle>{{0, 0, 1}, {0, 1, 0}}));
}

TEST(ValidateMesh, AcceptsASoundMesh) { EXPECT_EQ(complaint(one_triangle()), ""); }

TEST(ValidateMesh, RefusesAMeshWithoutTriangles) {
  TriangleMesh mesh = one_triangle();
  mesh.triangles.clear();
  EXPECT_THAT(complaint(mesh), HasSubstr("no triangles"));
}

TEST(ValidateMesh, NamesTheFirstBadVertex) {
  TriangleMesh mesh = one_triangle();
  mesh.vertices_nm[1].z = NAN;
  mesh.vertices_nm[2].x = HUGE_VAL;
  EXPECT_THAT(complaint(mesh), HasSubstr("vertex 1 is"));
}

TEST(ValidateMesh, NamesTheFirstBadIndex) {
  TriangleMesh mesh = one_triangle();
  mesh.triangles.push_back({0, 1, 3});
  EXPECT_THAT(complaint(mesh), HasSubstr("triangle 1 has the corner 3, but there are 3 vertices"));
}

}  // namespace surf
