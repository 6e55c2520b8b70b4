// SPDX-License-Identifier: GPL-3.0-or-later
// That a simplified mesh keeps its tolerance everywhere, on meshes that make this hard.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mesh_test.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/simplify_mesh.h"

namespace surf {
namespace {

using test::append;

TriangleMesh rough_body() { return height_field_solid(make_rough({60, 40, 1}, 4, 12, 3), -40); }

/// A fine box whose top is moved up by `height(x, y)`.
TriangleMesh body(const std::function<double(double x, double y)>& height, int pieces = 40) {
  TriangleMesh m = make_box({0, 0, 0}, {20, 20, 20}, pieces);
  for (Vec3& v : m.vertices_nm)
    if (v.z == 20) v.z += height(v.x, v.y);
  return m;
}

double slope(double x) { return std::clamp(x, 0.0, 1.0); }

struct Case {
  std::string name;
  TriangleMesh mesh;
};

std::vector<Case> hard_cases() {
  std::vector<Case> cases;
  cases.push_back({"spikes", body([](double x, double y) {
                     return (std::fmod(x, 4) == 2 && std::fmod(y, 4) == 2) ? 3.0 : 0.0;
                   })});
  cases.push_back({"thin fins", body([](double x, double y) {
                     return std::fmod(x, 5) == 2.5 && y > 3 && y < 17 ? 4.0 : 0.0;
                   })});
  // Two folds of the top lie above each other, 0.2 apart.
  TriangleMesh folded = body([](double, double) { return 0; });
  for (Vec3& v : folded.vertices_nm) {
    if (v.z != 20) continue;
    const double s = v.x / 20, rim = 20 * std::min({slope(v.y - 1), slope(19 - v.y)});
    v.x += rim * 0.3 * std::sin(2 * M_PI * s);
    v.z += rim * (0.01 * std::sin(2 * M_PI * s) + 0.05 * std::sin(M_PI * s));
  }
  cases.push_back({"folded sheet", folded});
  TriangleMesh coincident = make_box({0, 0, 0}, {10, 10, 10}, 12);
  append(coincident, make_box({10, 0, 0}, {20, 10, 10}, 12));
  append(coincident, make_box({0, 0, 10}, {10, 10, 20}, 17));
  cases.push_back({"coincident sheets", coincident});
  TriangleMesh slivers = make_cone({0, 0, 0}, 10, 2, 30, 64);
  for (Vec3& v : slivers.vertices_nm) v.z *= 1 + 1e-6 * std::sin(7 * v.x);
  append(slivers, make_cone({40, 0, 0}, 10, 10, 1e-3, 64));
  cases.push_back({"slivers", slivers});
  cases.push_back({"plates", height_field_solid(make_rough({40, 40, 0.5}, 0.02, 3, 5), -0.15)});
  cases.push_back({"steep noise", body([](double x, double y) {
                     return 2 * std::sin(1e4 * std::sin(12.9898 * x + 78.233 * y));
                   })});
  cases.push_back({"ball", make_sphere({}, 20, 4)});
  cases.push_back({"far away", make_sphere({1e6, -1e6, 1e6}, 20, 4)});
  return cases;
}

}  // namespace

TEST(SimplifyMesh, ProvesItsToleranceOnHardMeshes) {
  for (const Case& c : hard_cases()) {
    std::size_t removed = 0;
    for (const double tolerance : {0.05, 0.5, 2.5}) {
      const auto [simple, s] = simplify_mesh(c.mesh, {.tolerance_nm = tolerance, .threads = 2});
      const std::string name = c.name + " within " + std::to_string(tolerance);
      EXPECT_TRUE(s.deviation.proven()) << name;
      EXPECT_LE(s.deviation.largest_nm(), tolerance) << name;
      const MeshDeviation d = mesh_deviation(c.mesh, simple, {.spacing_nm = 0.2, .threads = 2});
      // What is measured is itself rounded.
      EXPECT_LE(d.from_first_nm, s.deviation.from_first_nm + 1e-9) << name;
      EXPECT_LE(d.from_second_nm, s.deviation.from_second_nm + 1e-9) << name;
      EXPECT_LE(s.deviation.largest_nm(), 1.02 * d.largest_nm() + 0.01) << name << ", tight";
      const MeshReport before = check_mesh(c.mesh), after = check_mesh(simple);
      EXPECT_EQ(after.closed_and_oriented, before.closed_and_oriented) << name;
      EXPECT_EQ(after.components, before.components) << name;
      EXPECT_EQ(after.duplicate_triangles, before.duplicate_triangles) << name;
      EXPECT_LE(after.degenerate_triangles, before.degenerate_triangles) << name;
      removed += s.triangles_before - s.triangles_after;
    }
    EXPECT_GT(removed, c.mesh.triangles.size() / 4) << c.name;
  }
}

TEST(SimplifyMesh, RestoresWhatItCannotProve) {
  // So many vertices belong to a face that decimation alone goes too far, and has to take back.
  std::size_t restored = 0;
  const TriangleMesh ball = make_sphere({}, 20, 6);
  for (const double tolerance : {1.8, 2.0, 2.2}) {
    const auto [simple, s] = simplify_mesh(ball, {.tolerance_nm = tolerance});
    restored += s.restored;
    EXPECT_EQ(s.restored > 0, s.attempts > 1);
    EXPECT_EQ(s.end, SimplifyEnd::no_candidate);
    EXPECT_LE(s.deviation.largest_nm(), tolerance);
    EXPECT_LT(s.triangles_after, 200u) << "only near what was not proven";
  }
  EXPECT_GT(restored, 0u) << "otherwise this test does not test";
}

TEST(SimplifyMesh, DoesNotPassThroughItselfWhereTheOriginalIsSmooth) {
  const TriangleMesh rough = height_field_solid(make_rough({150, 150, 1}, 4, 10, 1), -50);
  for (const double tolerance : {0.05, 0.1}) {
    const TriangleMesh simple = simplify_mesh(rough, {.tolerance_nm = tolerance}).mesh;
    EXPECT_TRUE(find_self_intersections(simple).pairs.empty()) << tolerance;
  }
}

TEST(SimplifyMesh, GivesTheSameBytesForAnyThreads) {
  for (const TriangleMesh& mesh : {rough_body(), make_sphere({}, 20, 5)}) {
    const auto [one, s] = simplify_mesh(mesh, {.tolerance_nm = 2, .threads = 1});
    for (const int threads : {2, 3, 8}) {
      const auto [more, t] = simplify_mesh(mesh, {.tolerance_nm = 2, .threads = threads});
      EXPECT_TRUE(test::same(more, one)) << threads;
      EXPECT_EQ(t.deviation.from_first_nm, s.deviation.from_first_nm);
      EXPECT_EQ(t.deviation.from_second_nm, s.deviation.from_second_nm);
      EXPECT_EQ(t.restored, s.restored);
    }
  }
}

TEST(SimplifyMesh, UsesTheTolerance) {
  const auto [simple, s] = simplify_mesh(rough_body(), {.tolerance_nm = 0.2});
  EXPECT_GT(s.deviation.largest_nm(), 0.19);
  EXPECT_LT(s.triangles_after, s.triangles_before / 4);
}

TEST(SimplifyMesh, SaysWhyItEnds) {
  const TriangleMesh ball = make_sphere({}, 20, 4);
  EXPECT_EQ(simplify_mesh(ball, {.triangles = 100}).summary.end, SimplifyEnd::triangles);
  EXPECT_EQ(simplify_mesh(ball, {.tolerance_nm = 0.1}).summary.end, SimplifyEnd::no_candidate);
  // Squares of these coordinates overflow.
  const TriangleMesh huge = make_box({0, 0, 0}, {1e200, 1e200, 1e200}, 4);
  const auto [kept, s] = simplify_mesh(huge, {.tolerance_nm = 1e199});
  EXPECT_EQ(s.end, SimplifyEnd::not_proven);
  EXPECT_EQ(kept.triangles.size(), huge.triangles.size());
  EXPECT_EQ(s.deviation.largest_nm(), 0);
  const SimplifySummary few = simplify_mesh(huge, {.triangles = 12}).summary;
  EXPECT_TRUE(few.triangles_after == few.triangles_before || !few.deviation.proven());
}

TEST(SimplifyMesh, DropsTrianglesThatBoundNothing) {
  TriangleMesh mesh = make_box({0, 0, 0}, {1, 1, 1}, 6);
  mesh.vertices_nm.push_back({0.5, 0.5, 3});
  mesh.triangles.push_back({0, 0, static_cast<std::uint32_t>(mesh.vertices_nm.size() - 1)});
  const auto [simple, s] = simplify_mesh(mesh, {.tolerance_nm = 1e-3});
  EXPECT_EQ(s.triangles_after, 12u);
  EXPECT_EQ(s.end, SimplifyEnd::no_candidate);
}

}  // namespace surf
