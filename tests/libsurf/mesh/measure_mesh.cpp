// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/measure_mesh.h"

#include <gtest/gtest.h>

#include <numbers>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {

TEST(MeasureMesh, ABoxHasItsSizes) {
  const MeshMeasures m = measure_mesh(make_box({1, 2, 3}, {3, 5, 9}));
  EXPECT_DOUBLE_EQ(m.area_nm2, 2 * (6 + 18 + 12));
  EXPECT_DOUBLE_EQ(m.volume_nm3, 36);
  EXPECT_EQ(m.centroid_nm, (Vec3{2, 3.5, 6}));
  EXPECT_DOUBLE_EQ(m.shortest_edge_nm, 2);
  EXPECT_DOUBLE_EQ(m.longest_edge_nm, std::hypot(3, 6));
  EXPECT_NEAR(m.gaussian_integral, 4 * std::numbers::pi, 1e-12) << "Gauss and Bonnet";
  // Steiner: pi / 4 for every unit of an edge at right angles... summed: pi (a + b + c).
  EXPECT_GT(m.mean_integral_nm, 0);
}

TEST(MeasureMesh, GaussAndBonnetHoldForEveryClosedBody) {
  TriangleMesh two = make_sphere({}, 3, 2);
  test::append(two, height_field_solid(make_rough({30, 20, 1}, 2, 5, 1), -9));
  EXPECT_NEAR(measure_mesh(two).gaussian_integral, 8 * std::numbers::pi, 1e-9);
}

TEST(MeshCurvature, OfASphere) {
  for (const double radius : {0.5, 20.0}) {
    const TriangleMesh sphere = make_sphere({7, 8, 9}, radius, 5);
    for (const Curvature& c : mesh_curvature(sphere)) {
      EXPECT_NEAR(c.mean_per_nm * radius, 1, 0.02);
      EXPECT_NEAR(c.gaussian_per_nm2 * radius * radius, 1, 0.15);
    }
    for (const Curvature& c : mesh_curvature(test::turned(sphere))) EXPECT_LT(c.mean_per_nm, 0);
    const MeshMeasures m = measure_mesh(sphere);
    EXPECT_NEAR(m.mean_integral_nm, 4 * std::numbers::pi * radius, 0.02 * radius);
  }
}

TEST(MeshCurvature, IsZeroAtRimsAndOnPlanes) {
  const TriangleMesh sheet = height_field_sheet(make_mesa({10, 10, 1}, 5, 2, 3));
  const std::vector<Curvature> c = mesh_curvature(sheet);
  ASSERT_EQ(c.size(), 121u);
  EXPECT_EQ(c[0].mean_per_nm, 0);
  EXPECT_EQ(c[5 * 11 + 5].mean_per_nm, 0) << "the middle of the top";
  EXPECT_GT(c[5 * 11 + 6].mean_per_nm, 0.1) << "the edge of the top bends as a ball does";
}

TEST(MeasureMesh, RefusesDamagedMeshes) {
  EXPECT_THROW(measure_mesh({}), InvalidInput);
  EXPECT_THROW(mesh_curvature({}), InvalidInput);
}

}  // namespace surf
