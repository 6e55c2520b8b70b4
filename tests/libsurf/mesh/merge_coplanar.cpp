// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/merge_coplanar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += dot(mesh.vertices_nm[t[0]], cross(mesh.vertices_nm[t[1]], mesh.vertices_nm[t[2]])) / 6;
  return sum;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_nm[t[0]];
    sum += 0.5 * length(cross(mesh.vertices_nm[t[1]] - a, mesh.vertices_nm[t[2]] - a));
  }
  return sum;
}

// The same point set: as large, closed where it was, and nowhere farther than rounding from what it
// was.
void expect_same_surface(const TriangleMesh& before, const TriangleMesh& after) {
  EXPECT_NEAR(area(after), area(before), 1e-9 * area(before));
  EXPECT_NEAR(volume(after), volume(before), 1e-9 * std::fabs(volume(before)));
  const MeshReport a = check_mesh(before), b = check_mesh(after);
  EXPECT_EQ(b.closed_and_oriented, a.closed_and_oriented);
  EXPECT_EQ(b.components, a.components);
  EXPECT_LT(mesh_deviation(before, after).largest_nm(), 1e-9);
  EXPECT_TRUE(find_self_intersections(after, {}).pairs.empty());
}

void rotate(TriangleMesh& mesh, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3& v : mesh.vertices_nm) {
    v = {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
    v = {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
  }
}

TEST(MergeCoplanar, LeavesTwoTrianglesToEachSideOfABox) {
  const TriangleMesh fine = make_box({-3, -2, -1}, {3, 2, 1}, 8);
  const TriangleMesh merged = merge_coplanar(fine);
  EXPECT_EQ(merged.triangles.size(), 12u);
  EXPECT_EQ(merged.vertices_nm.size(), 8u);
  expect_same_surface(fine, merged);
}

TEST(MergeCoplanar, DoesSoHoweverTheBoxLies) {
  for (const double angle : {0.1, 0.7, 2.0, 4.0}) {
    TriangleMesh fine = make_box({-30, -20, -10}, {30, 20, 10}, 16);
    rotate(fine, angle);
    const TriangleMesh merged = merge_coplanar(fine);
    EXPECT_EQ(merged.triangles.size(), 12u) << angle;
    expect_same_surface(fine, merged);
  }
}

TEST(MergeCoplanar, KeepsCurvedSurfacesAsTheyAre) {
  const TriangleMesh sphere = make_sphere({1, 2, 3}, 10, 4);
  const TriangleMesh merged = merge_coplanar(sphere);
  EXPECT_EQ(merged.triangles, sphere.triangles);
  ASSERT_EQ(merged.vertices_nm.size(), sphere.vertices_nm.size());
  for (std::size_t i = 0; i < merged.vertices_nm.size(); ++i)
    EXPECT_TRUE(merged.vertices_nm[i] == sphere.vertices_nm[i]);
}

TEST(MergeCoplanar, FillsRegionsWithHoles) {
  // A plate with a round column on it: the plate's upper side is a region with a hole.
  HeightField field;
  field.z_nm = Grid<double>(41, 41);
  field.pitch_x_nm = field.pitch_y_nm = 1;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x)
      field.z_nm(x, y) = std::hypot(x - 20, y - 20) < 8 ? 5 + 0.01 * x * x : 0;
  const TriangleMesh fine = height_field_solid(field, -10);
  const TriangleMesh merged = merge_coplanar(fine);
  EXPECT_LT(merged.triangles.size(), 0.5 * static_cast<double>(fine.triangles.size()));
  expect_same_surface(fine, merged);
}

TEST(MergeCoplanar, MergesAMesaToItsFaces) {
  const HeightField mesa = make_mesa({398, 398, 2}, 200, 80, 20);
  const TriangleMesh fine = height_field_solid(mesa, -50);
  const TriangleMesh merged = merge_coplanar(fine);
  EXPECT_GT(fine.triangles.size(), 70000u);
  EXPECT_LT(merged.triangles.size(), 600u);
  expect_same_surface(fine, merged);
}

TEST(MergeCoplanar, KeepsTheRimOfASheet) {
  const HeightField flat = make_mesa({40, 40, 1}, 5, 10, 2);
  const TriangleMesh fine = half_space_top(flat, 100);
  const TriangleMesh merged = merge_coplanar(fine);
  EXPECT_LT(merged.triangles.size(), fine.triangles.size());
  EXPECT_NEAR(area(merged), area(fine), 1e-9 * area(fine));
  EXPECT_LT(mesh_deviation(fine, merged).largest_nm(), 1e-9);
}

TEST(MergeCoplanar, KeepsBodiesApartThatTouch) {
  TriangleMesh two = make_box({0, 0, 0}, {1, 1, 1}, 4);
  append(two, make_box({1, 0, 0}, {2, 1, 1},
                       4));  // their upper sides are in one plane, and share no corner's number
  EXPECT_EQ(merge_coplanar(two).triangles.size(), 24u);
}

TEST(MergeCoplanar, KeepsCornersThatOthersNeed) {
  // Half of the upper side is moved a little: the edge between both has many corners on one side
  // only at first.
  TriangleMesh body = make_box({0, 0, 0}, {8, 8, 2}, 8);
  for (Vec3& v : body.vertices_nm)
    if (v.z == 2 && v.x > 4) v.z += 0.05 * (v.x - 4) * (1 + 0.1 * v.y * v.y);
  const TriangleMesh merged = merge_coplanar(body);
  EXPECT_LT(merged.triangles.size(), body.triangles.size());
  expect_same_surface(body, merged);
}

TEST(MergeCoplanar, ToleratesNoMoreThanItIsTold) {
  TriangleMesh body = make_box({0, 0, 0}, {8, 8, 2}, 8);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> off(-1e-8, 1e-8);
  for (Vec3& v : body.vertices_nm) v += Vec3{off(random), off(random), off(random)};
  EXPECT_GT(merge_coplanar(body).triangles.size(), 600u);
  const TriangleMesh coarse = merge_coplanar(body, {.tolerance_nm = 1e-6});
  EXPECT_LT(coarse.triangles.size(), 20u);
  EXPECT_TRUE(check_mesh(coarse).closed_and_oriented);
  EXPECT_LT(mesh_deviation(body, coarse).largest_nm(), 2e-6);
  EXPECT_THROW(merge_coplanar(body, {.tolerance_nm = -1}), UsageError);
}

TEST(MergeCoplanar, LeavesNeedlesAndOpenEdgesAlone) {
  // A needle in a flat side, and a missing triangle.
  TriangleMesh body = make_box({0, 0, 0}, {8, 8, 2}, 4);
  body.triangles.pop_back();
  const auto corner = static_cast<std::uint32_t>(body.vertices_nm.size());
  body.vertices_nm.push_back({20, 0, 0});
  body.vertices_nm.push_back({30, 0, 0});
  body.vertices_nm.push_back({25, 1e-10, 0});
  body.triangles.push_back({corner, corner + 1, corner + 2});
  const TriangleMesh merged = merge_coplanar(body);
  EXPECT_NEAR(area(merged), area(body), 1e-9);
  EXPECT_LT(mesh_deviation(body, merged).largest_nm(), 1e-9);
  EXPECT_FALSE(check_mesh(merged).closed_and_oriented);
}

TEST(MergeCoplanar, IsInterrupted) {
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(merge_coplanar(make_box({0, 0, 0}, {1, 1, 1}, 30), {.watch = {{}, &cancel}}),
               Interrupted);
}

}  // namespace
}  // namespace surf
