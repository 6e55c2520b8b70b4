// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/repair_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;
using test::exploded;
using test::same;
using test::turned;
using testing::Contains;
using testing::HasSubstr;

/// Sound, of the volume and the number of triangles of the original.
void expect_mended(const RepairedMesh& r, const TriangleMesh& original) {
  EXPECT_TRUE(r.summary.sound());
  EXPECT_TRUE(r.summary.changed);
  const MeshReport truth = check_mesh(original);
  EXPECT_EQ(r.summary.after.triangles, truth.triangles);
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, truth.signed_volume_nm3,
              1e-9 * std::abs(truth.signed_volume_nm3));
}

/// A body with a cavity.
TriangleMesh hollow_sphere() {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 10, 3);
  append(mesh, turned(make_sphere({1, 0, 0}, 4, 2)));
  return mesh;
}

}  // namespace

TEST(RepairMesh, AGoodMeshComesBackUnchanged) {
  TriangleMesh pair = make_box({0, 0, 0}, {1, 1, 1});
  append(pair, make_box({1, 1, 0}, {2, 2, 1}));  // they touch along an edge
  TriangleMesh spare = make_sphere({0, 0, 0}, 5, 2);
  spare.vertices_nm.push_back({99, 99, 99});  // of no triangle
  const std::vector<TriangleMesh> good{make_box({0, 0, 0}, {1, 2, 3}, 4),
                                       make_sphere({0, 0, 0}, 5, 4),
                                       hollow_sphere(),
                                       merge_equal_vertices(pair),
                                       spare,
                                       height_field_solid(make_rough({60, 40, 2}, 5, 8, 1), -50),
                                       height_field_sheet(make_rough({60, 40, 2}, 5, 8, 1)),
                                       height_field_sheet(make_mesa({40, 40, 2}, 5, 8, 1))};
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const double scale : {1e-6, 1.0, 1e9}) {
      TriangleMesh mesh = good[i];
      transform(mesh, scale, {3 * scale, 0, 0});
      const RepairedMesh r = repair_mesh(mesh);
      EXPECT_TRUE(same(r.mesh, mesh)) << i;
      EXPECT_FALSE(r.summary.changed) << i;
      EXPECT_EQ(describe(r.summary)[0], "nothing to mend");
    }
  }
}

TEST(RepairMesh, WhatItMendedItLeavesAlone) {
  TriangleMesh mesh = exploded(make_sphere({0, 0, 0}, 5, 3));
  mesh.triangles.erase(mesh.triangles.begin() + 7, mesh.triangles.begin() + 10);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const RepairedMesh once = repair_mesh(mesh);
  EXPECT_TRUE(once.summary.sound());
  const RepairedMesh twice = repair_mesh(once.mesh);
  EXPECT_FALSE(twice.summary.changed);
  EXPECT_TRUE(same(twice.mesh, once.mesh));
}

TEST(RepairMesh, MergesVerticesAtEqualPlaces) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3}, 3);
  const RepairedMesh r = repair_mesh(exploded(box));
  expect_mended(r, box);
  EXPECT_EQ(r.summary.merged_vertices, 3 * box.triangles.size() - box.vertices_nm.size());
  EXPECT_THAT(describe(r.summary), Contains("merged 268 vertices at equal places"));
}

TEST(RepairMesh, StitchesRimsThatAreNearlyEqual) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3}, 3);
  TriangleMesh mesh = exploded(box);
  for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
    mesh.vertices_nm[i].x += 1e-7 * std::sin(1.0 + double(i));
  }
  const RepairedMesh r = repair_mesh(mesh);
  EXPECT_TRUE(r.summary.sound());
  EXPECT_EQ(r.summary.after.vertices, box.vertices_nm.size());
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, 6, 1e-5);
  EXPECT_EQ(repair_mesh(mesh, {.stitch_nm = 0.0}).summary.stitched_vertices, 0u);
}

TEST(RepairMesh, TurnsTrianglesByTheMajority) {
  const TriangleMesh sphere = make_sphere({0, 0, 0}, 5, 3);
  TriangleMesh mesh = sphere;
  for (const std::size_t t : {3, 4, 77, 1000})
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const RepairedMesh r = repair_mesh(mesh);
  expect_mended(r, sphere);
  EXPECT_EQ(r.summary.turned_triangles, 4u);
}

TEST(RepairMesh, TurnsBodiesOutwardAndKeepsCavities) {
  const RepairedMesh r = repair_mesh(turned(make_sphere({0, 0, 0}, 5, 2)));
  EXPECT_GT(r.summary.after.signed_volume_nm3, 0);
  EXPECT_EQ(r.summary.turned_triangles, 320u);
  TriangleMesh inside_out = turned(make_sphere({0, 0, 0}, 10, 3));
  append(inside_out, turned(make_sphere({1, 0, 0}, 4, 2)));
  expect_mended(repair_mesh(inside_out), hollow_sphere());
}

TEST(RepairMesh, RemovesCopiesAndFaceBackToBack) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1}, 2);
  TriangleMesh mesh = box;
  mesh.triangles.push_back(box.triangles[5]);
  mesh.triangles.push_back({box.triangles[9][1], box.triangles[9][2], box.triangles[9][0]});
  expect_mended(repair_mesh(mesh), box);
  EXPECT_EQ(repair_mesh(mesh).summary.removed_duplicates, 2u);

  mesh = box;  // a wall inside, seen from both sides
  const auto n = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.push_back({0.5, 0.5, 0.5});
  const auto [a, b, c] = box.triangles[0];
  mesh.triangles.push_back({a, b, n});
  mesh.triangles.push_back({b, a, n});
  expect_mended(repair_mesh(mesh), box);

  mesh = box;  // a face that closes the surface, and its copy turned over
  mesh.triangles.push_back({b, a, c});
  const RepairedMesh kept = repair_mesh(mesh);
  EXPECT_TRUE(kept.summary.sound());
  EXPECT_EQ(kept.summary.after.triangles, box.triangles.size());
}

TEST(RepairMesh, RemovesTrianglesWithoutArea) {
  // A vertex in the middle of an edge, joined by triangles without area.
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  TriangleMesh mesh = box;
  const auto [a, b, c] = mesh.triangles[0];
  const auto m = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.push_back((mesh.vertices_nm[a] + mesh.vertices_nm[b]) * 0.5);
  mesh.triangles[0] = {a, m, c};
  mesh.triangles.push_back({m, b, c});
  mesh.triangles.push_back({a, b, m});
  mesh.triangles.push_back({a, a, b});
  ASSERT_EQ(check_mesh(mesh).degenerate_triangles, 2u);
  ASSERT_TRUE(check_mesh(mesh).closed_and_oriented);
  const RepairedMesh r = repair_mesh(mesh);
  EXPECT_TRUE(r.summary.sound());
  EXPECT_EQ(r.summary.removed_degenerate, 2u);
  EXPECT_EQ(r.summary.after.triangles, 14u) << "both sides of the edge are cut in two";
  EXPECT_DOUBLE_EQ(r.summary.after.signed_volume_nm3, 1);
  EXPECT_EQ(find_self_intersections(r.mesh).pairs.size(), 0u);
}

TEST(RepairMesh, RemovesSliversOnRequest) {
  TriangleMesh mesh = make_box({0, 0, 0}, {8, 8, 8}, 4);
  mesh.vertices_nm.push_back({});
  for (Vec3& v : mesh.vertices_nm) {
    if (v == Vec3{2, 2, 8}) v = {3.999, 2.0005, 8};  // beside (4, 2, 8)
  }
  EXPECT_FALSE(repair_mesh(mesh).summary.changed);
  const RepairedMesh r = repair_mesh(mesh, {.sliver_nm = 0.01});
  EXPECT_TRUE(r.summary.sound());
  EXPECT_GT(r.summary.removed_degenerate, 0u);
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, 512, 1e-9);
}

TEST(RepairMesh, FillsHolesUpToTheLimit) {
  const TriangleMesh sphere = make_sphere({0, 0, 0}, 10, 4);
  TriangleMesh mesh = sphere;
  std::erase_if(mesh.triangles,
                [&](const Triangle& t) { return sphere.vertices_nm[t[0]].z > 9.5; });
  mesh.triangles.erase(mesh.triangles.begin());
  RepairedMesh r = repair_mesh(mesh);
  EXPECT_TRUE(r.summary.sound());
  EXPECT_EQ(r.summary.filled_holes, 2u);
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, check_mesh(sphere).signed_volume_nm3, 15);
  EXPECT_TRUE(r.summary.open_holes.empty());

  r = repair_mesh(mesh, {.max_hole_nm = 5.0});
  EXPECT_EQ(r.summary.filled_holes, 1u);
  ASSERT_EQ(r.summary.open_holes.size(), 1u);
  EXPECT_TRUE(r.summary.open_holes[0].too_large);
  EXPECT_NEAR(r.summary.open_holes[0].perimeter_nm, 24, 5) << "a jagged circle";
  EXPECT_GT(r.summary.open_holes[0].place_nm.z, 8);
  EXPECT_THAT(describe(r.summary), Contains(HasSubstr("left open: a hole of")));
}

TEST(RepairMesh, FillsTheSideOfABoxIfToldSo) {
  TriangleMesh mesh = make_box({0, 0, 0}, {1, 1, 1}, 3);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices_nm[t[0]].z == 1 && mesh.vertices_nm[t[1]].z == 1 &&
           mesh.vertices_nm[t[2]].z == 1;
  });
  EXPECT_FALSE(repair_mesh(mesh).summary.changed) << "its rim is longer than the diagonal";
  const RepairedMesh r = repair_mesh(mesh, {.max_hole_nm = 4.01});
  EXPECT_TRUE(r.summary.sound());
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, 1, 1e-12);
}

TEST(RepairMesh, NeverMakesASheetABody) {
  for (const double limit : {0.0, 1.0, 1e9}) {
    const TriangleMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_FALSE(repair_mesh(one, {.max_hole_nm = limit}).summary.changed);
  }
}

TEST(RepairMesh, UnitesBodiesThatPassThroughEachOther) {
  TriangleMesh mesh = make_box({0, 0, 0}, {10, 10, 10});
  append(mesh, make_box({5, 5, 5}, {15, 15, 15}));
  append(mesh, make_sphere({50, 0, 0}, 3, 2));
  const double sphere = check_mesh(make_sphere({50, 0, 0}, 3, 2)).signed_volume_nm3;
  const RepairedMesh r = repair_mesh(mesh);
  EXPECT_TRUE(r.summary.sound());
  EXPECT_GT(r.summary.self_intersections_before, 0u);
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, 2000 - 125 + sphere, 1e-6);
  EXPECT_EQ(r.summary.after.components, 2u);
  const RepairedMesh counted = repair_mesh(mesh, {.resolve_self_intersections = false});
  EXPECT_FALSE(counted.summary.changed);
  EXPECT_TRUE(same(counted.mesh, mesh));
  EXPECT_EQ(counted.summary.self_intersections_after, r.summary.self_intersections_before);
  EXPECT_THAT(describe(counted.summary), Contains(HasSubstr("self-intersections near (")));
}

TEST(RepairMesh, MendsASurfaceThatPassesThroughItself) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 10, 4);
  mesh.vertices_nm[200] = mesh.vertices_nm[200] * -1.1;  // through the far side
  ASSERT_FALSE(find_self_intersections(mesh).pairs.empty());
  const RepairedMesh r = repair_mesh(mesh);
  EXPECT_TRUE(r.summary.sound());
  EXPECT_NEAR(r.summary.after.signed_volume_nm3, 4180, 60);
}

TEST(RepairMesh, DropsTinyComponentsOnRequest) {
  const TriangleMesh sphere = make_sphere({0, 0, 0}, 10, 3);
  TriangleMesh mesh = sphere;
  append(mesh, make_sphere({20, 0, 0}, 0.1, 1));
  EXPECT_FALSE(repair_mesh(mesh).summary.changed);
  const RepairedMesh r = repair_mesh(mesh, {.min_component_nm = 1});
  expect_mended(r, sphere);
  EXPECT_EQ(r.summary.dropped_components, 1u);
}

TEST(RepairMesh, ThreadsDoNotChangeTheResult) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 10, 4);
  append(mesh, make_sphere({7, 1, 2}, 10, 4));
  const TriangleMesh a = repair_mesh(mesh, {.threads = 1}).mesh;
  const TriangleMesh b = repair_mesh(mesh, {.threads = 3}).mesh;
  // CGAL's new points may differ in their last digits, as memory is laid out differently.
  EXPECT_EQ(a.triangles.size(), b.triangles.size());
  ASSERT_EQ(a.vertices_nm.size(), b.vertices_nm.size());
  const MeshReport ra = check_mesh(a), rb = check_mesh(b);
  EXPECT_NEAR(ra.signed_volume_nm3, rb.signed_volume_nm3, 1e-9 * ra.signed_volume_nm3);
  EXPECT_NEAR(ra.area_nm2, rb.area_nm2, 1e-9 * ra.area_nm2);
}

TEST(RepairMesh, RefusesBadArguments) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(repair_mesh(box, {.stitch_nm = -1.0}), UsageError);
  EXPECT_THROW(repair_mesh(box, {.sliver_nm = NAN}), UsageError);
  EXPECT_THROW(repair_mesh(box, {.max_hole_nm = -1.0}), UsageError);
  EXPECT_THROW(repair_mesh(box, {.min_component_nm = -1}), UsageError);
  EXPECT_THROW(repair_mesh({}), InvalidInput);
}

}  // namespace surf
