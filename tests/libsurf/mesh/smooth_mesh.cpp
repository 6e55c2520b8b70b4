// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/smooth_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

/// A sphere whose vertices jump in and out.
TriangleMesh noisy_sphere() {
  TriangleMesh mesh = make_sphere({}, 10, 4);
  for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
    mesh.vertices_nm[i] *= 1 + 0.02 * std::sin(1e3 * double(i * i % 977));
  }
  return mesh;
}

double roughness(const TriangleMesh& mesh) {
  double mean = 0, squares = 0;
  for (const Vec3& v : mesh.vertices_nm) {
    mean += length(v);
    squares += dot(v, v);
  }
  const double n = double(mesh.vertices_nm.size());
  return std::sqrt(squares / n - mean * mean / n / n);
}

}  // namespace

TEST(SmoothMesh, TakesNoiseAwayAndKeepsTheVolume) {
  const TriangleMesh noisy = noisy_sphere();
  const TriangleMesh smooth = smooth_mesh(noisy, {.iterations = 20});
  EXPECT_LT(roughness(smooth), 0.4 * roughness(noisy));
  const double volume = check_mesh(make_sphere({}, 10, 4)).signed_volume_nm3;
  EXPECT_NEAR(check_mesh(smooth).signed_volume_nm3, volume, 0.01 * volume);
  EXPECT_EQ(smooth.triangles, noisy.triangles);
}

TEST(SmoothMesh, ZeroIterationsChangeNothing) {
  EXPECT_TRUE(test::same(smooth_mesh(noisy_sphere(), {.iterations = 0}), noisy_sphere()));
}

TEST(SmoothMesh, RimsStayAndPlanesStayFlat) {
  const TriangleMesh flat = height_field_sheet(make_mesa({20, 20, 1}, 1e-9, 1, 1));
  TriangleMesh bumpy = flat;
  bumpy.vertices_nm[10 * 21 + 10].z = 3;
  const TriangleMesh smooth = smooth_mesh(bumpy, {});
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_EQ(smooth.vertices_nm[i], flat.vertices_nm[i]);
    EXPECT_EQ(smooth.vertices_nm[20 * 21 + i], flat.vertices_nm[20 * 21 + i]);
  }
  EXPECT_LT(smooth.vertices_nm[10 * 21 + 10].z, 1);
}

TEST(SmoothMesh, VerticesAtEqualPlacesMoveTogether) {
  const TriangleMesh merged = smooth_mesh(noisy_sphere(), {});
  EXPECT_TRUE(
      test::same(smooth_mesh(test::exploded(noisy_sphere()), {}), test::exploded(merged)) ||
      length(merge_equal_vertices(smooth_mesh(test::exploded(noisy_sphere()), {})).vertices_nm[0] -
             merge_equal_vertices(test::exploded(merged)).vertices_nm[0]) < 1e-9);
  EXPECT_EQ(check_mesh(smooth_mesh(test::exploded(noisy_sphere()), {})).boundary_edges, 0u);
}

TEST(SmoothMesh, RefusesBadArguments) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(smooth_mesh(box, {.iterations = -1}), UsageError);
  EXPECT_THROW(smooth_mesh(box, {.step = 0}), UsageError);
  EXPECT_THROW(smooth_mesh(box, {.step = NAN}), UsageError);
  EXPECT_THROW(smooth_mesh(box, {.pass_band = 1}), UsageError);
  EXPECT_THROW(smooth_mesh({}), InvalidInput);
  EXPECT_THROW(smooth_mesh(make_box({0, 0, 0}, {1, 1e308, 1})), InvalidInput);
}

}  // namespace surf
