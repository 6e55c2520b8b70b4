// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/vertex_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/mesh/shapes.h"

namespace surf {
namespace {

void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LT(length(found - expected), 1e-12) << found.x << ' ' << found.y << ' ' << found.z;
}

/// The corner of a cube at the origin, outside it, its faces cut into triangles unevenly.
TriangleMesh cube_corner(double size) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}, {0, 5, 1}, {1, 5, 6}}};
  for (Vec3& v : mesh.vertices_nm) v *= size;
  return mesh;
}

TEST(VertexNormals, DoNotDependOnHowFacesAreCut) {
  const double third = 1 / std::sqrt(3.0);
  for (const double size : {1e-200, 1e-3, 1.0, 1e9, 1e200, 1e308}) {
    expect_near(vertex_normals(cube_corner(size)).at(0), {third, third, third});
  }
}

TEST(VertexNormals, AreUprightWhereNothingCounts) {
  // A vertex without triangles, one of triangles without area, one whose triangles cancel.
  const TriangleMesh mesh{
      {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}, {6, 0, 0}, {5, 0, 1}},
      {{1, 2, 3}, {1, 1, 2}, {4, 5, 6}, {4, 6, 5}}};
  for (const Vec3& normal : vertex_normals(mesh)) EXPECT_EQ(normal, (Vec3{0, 0, 1}));
}

TEST(VertexNormals, HaveLengthOneAndPointOutOfABall) {
  const TriangleMesh ball = make_sphere({}, 10, 3);
  const std::vector<Vec3> normals = vertex_normals(ball);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(length(normals[i]), 1, 1e-12);
    EXPECT_GT(dot(normals[i], normalized(ball.vertices_nm[i])), 0.99);
  }
}

}  // namespace
}  // namespace surf
