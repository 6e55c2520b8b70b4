// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/open_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

using test::append;
using test::turned;
using testing::HasSubstr;

/// The area seen from above, counted negative where normals point down.
double projected_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_nm;
    area += 0.5 * cross(v[b] - v[a], v[c] - v[a]).z;
  }
  return area;
}

TriangleMesh rough_sheet() { return height_field_sheet(make_rough({60, 40, 2}, 5, 8, 1)); }

/// A fan of triangles about (0, 0): its rim at these places, at height i.
TriangleMesh fan(const std::vector<std::pair<double, double>>& rim) {
  TriangleMesh mesh{{{0, 0, 7}}, {}};
  const auto n = static_cast<std::uint32_t>(rim.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.vertices_nm.push_back({rim[i].first, rim[i].second, double(i)});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

std::string refusal(const TriangleMesh& mesh) {
  std::string reason;
  EXPECT_FALSE(extend_open_sheet(mesh, 10, reason));
  return reason;
}

/// The extended sheet is a disc whose projection covers everything once, and whose rim is at least
/// `apron_nm` outside the box.
void expect_extended(const TriangleMesh& sheet, double apron_nm) {
  std::string reason;
  const auto top = extend_open_sheet(sheet, apron_nm, reason);
  ASSERT_TRUE(top) << reason;
  const MeshReport before = check_mesh(sheet);
  const MeshReport after = check_mesh(*top);
  EXPECT_EQ(after.boundary_edges, before.boundary_edges);
  EXPECT_EQ(after.nonmanifold_edges + after.inconsistent_edges + after.nonmanifold_vertices, 0u);
  EXPECT_EQ(after.triangles, before.triangles + 2 * before.boundary_edges);
  EXPECT_EQ(after.bounds_nm.lower_nm.z, before.bounds_nm.lower_nm.z);
  EXPECT_EQ(after.bounds_nm.upper_nm.z, before.bounds_nm.upper_nm.z);

  // The new vertices come last; the polygon they make is the new rim, counter-clockwise.
  const std::size_t n = before.boundary_edges;
  const std::size_t first = top->vertices_nm.size() - n;
  double area = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = top->vertices_nm[first + i];
    const Vec3 b = top->vertices_nm[first + (i + 1) % n];
    area += 0.5 * (a.x * b.y - a.y * b.x);
    for (int k = 0; k <= 16; ++k) {
      const Vec3 p = a + (b - a) * (k / 16.0);
      const double dx =
          std::max({before.bounds_nm.lower_nm.x - p.x, p.x - before.bounds_nm.upper_nm.x, 0.0});
      const double dy =
          std::max({before.bounds_nm.lower_nm.y - p.y, p.y - before.bounds_nm.upper_nm.y, 0.0});
      EXPECT_GE(std::hypot(dx, dy), apron_nm * (1 - 1e-9));
    }
  }
  EXPECT_NEAR(projected_area(*top), area, 1e-9 * area) << "every place below the new rim, once";
}

}  // namespace

TEST(ExtendOpenSheet, DrawsTheRimOutHorizontally) {
  for (const double apron : {0.001, 10.0, 1e5}) expect_extended(rough_sheet(), apron);
  expect_extended(fan({{1, 0}, {0, 1}, {-1, -1}}), 3);
  expect_extended(
      fan({{9, -1}, {9, 1}, {2, 2}, {0, 8}, {-2, 2}, {-9, 0}, {-2, -2}, {0, -8}, {2, -2}}), 3);
}

TEST(ExtendOpenSheet, MovesRimVerticesRadiallyAtTheirHeight) {
  std::string reason;
  const TriangleMesh square = fan({{1, -1}, {1, 1}, {-1, 1}, {-1, -1}});
  const auto top = extend_open_sheet(square, 8, reason);
  ASSERT_TRUE(top) << reason;
  ASSERT_EQ(top->vertices_nm.size(), 9u);
  // The far circle has radius sqrt(2) + 8; chords over a quarter need 1 / cos(45 deg) more.
  const double far = (std::sqrt(2.0) + 8) * std::sqrt(2.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 inner = top->vertices_nm[1 + i];
    const Vec3 outer = top->vertices_nm[5 + i];
    EXPECT_EQ(inner, square.vertices_nm[1 + i]);
    EXPECT_EQ(outer.z, inner.z);
    EXPECT_NEAR(outer.x, inner.x * far / std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(outer.y, inner.y * far / std::sqrt(2.0), 1e-12);
  }
}

TEST(ExtendOpenSheet, TurnsASheetThatPointsDown) {
  const TriangleMesh down = turned(rough_sheet());
  EXPECT_LT(projected_area(down), 0);
  expect_extended(rough_sheet(), 5);
  std::string reason;
  const auto top = extend_open_sheet(down, 5, reason);
  ASSERT_TRUE(top) << reason;
  EXPECT_GT(projected_area(*top), 60 * 40);
  EXPECT_EQ(check_mesh(*top).inconsistent_edges, 0u);
}

TEST(ExtendOpenSheet, LeavesClosedBodiesBesideTheSheetAlone) {
  TriangleMesh mesh = turned(rough_sheet());
  append(mesh, make_box({-5, -5, 50}, {5, 5, 60}));
  std::string reason;
  const auto top = extend_open_sheet(mesh, 5, reason);
  ASSERT_TRUE(top) << reason;
  const double body = check_mesh(make_box({-5, -5, 50}, {5, 5, 60})).signed_volume_nm3;
  mesh = *top;
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  TriangleMesh box{mesh.vertices_nm, {}};
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] == 1) box.triangles.push_back(mesh.triangles[t]);
  }
  EXPECT_NEAR(check_mesh(box).signed_volume_nm3, body, 1e-9);
}

TEST(ExtendOpenSheet, RefusesABodyWithAHole) {
  // A sphere without its lowest triangles: a hole to be filled, not a mushroom on a plane.
  TriangleMesh cap = make_sphere({0, 0, 0}, 10, 4);
  std::erase_if(cap.triangles, [&](const Triangle& t) {
    double z = 0;
    for (const std::uint32_t v : t) z += cap.vertices_nm[v].z / 3;
    return z < -9;
  });
  std::string reason;
  EXPECT_FALSE(extend_open_sheet(merge_equal_vertices(cap), 30, reason));
  EXPECT_THAT(reason, testing::HasSubstr("sideways beyond its rim"));
}

TEST(ExtendOpenSheet, WorksFarFromTheOrigin) {
  TriangleMesh sheet = rough_sheet();
  transform(sheet, 1, {1e6, -1e6, 5});
  std::string reason;
  const auto top = extend_open_sheet(sheet, 100, reason);
  ASSERT_TRUE(top) << reason;
  EXPECT_NEAR(bounds(*top).center_nm().x, 1e6, 10);
}

TEST(ExtendOpenSheet, SaysWhyNot) {
  EXPECT_THAT(refusal(make_box({0, 0, 0}, {1, 1, 1})), HasSubstr("no rim"));

  TriangleMesh pierced = rough_sheet();
  pierced.triangles.erase(pierced.triangles.begin() + 500);
  EXPECT_THAT(refusal(pierced), HasSubstr("2 rims"));

  TriangleMesh twisted = rough_sheet();
  std::swap(twisted.triangles[500][0], twisted.triangles[500][1]);
  EXPECT_THAT(refusal(twisted), HasSubstr("turned against each other near ("));

  TriangleMesh finned = rough_sheet();
  const Triangle t = finned.triangles[500];
  append(finned, {{finned.vertices_nm[t[0]], finned.vertices_nm[t[1]], {0, 0, 90}}, {{0, 1, 2}}});
  EXPECT_THAT(refusal(finned), HasSubstr("more than two triangles"));

  TriangleMesh hourglass = fan({{1, -1}, {2, 0}, {1, 1}});
  hourglass.triangles = {{0, 1, 2}, {0, 2, 3}};
  append(hourglass, turned({{{0, 0, 7}, {-1, -1, 0}, {-1, 1, 0}}, {{0, 1, 2}}}));
  EXPECT_THAT(refusal(hourglass), HasSubstr("touch in a point"));

  // An L has its centroid inside, but cannot see all of its own rim.
  const TriangleMesh ell = fan({{-1, -1}, {40, -1}, {40, 1}, {1, 1}, {1, 40}, {-1, 40}});
  EXPECT_THAT(refusal(ell), HasSubstr("star-shaped"));

  // A sheet on edge has no area from above.
  EXPECT_THAT(refusal({{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}, {{0, 1, 2}}}), HasSubstr("star-shaped"));
}

TEST(ExtendOpenSheet, RefusesARimThatGoesRoundTwice) {
  std::vector<std::pair<double, double>> rim;
  for (int i = 0; i < 12; ++i) {
    rim.emplace_back(10 * std::cos(std::numbers::pi * i / 3),
                     10 * std::sin(std::numbers::pi * i / 3));
  }
  const TriangleMesh spiral = fan(rim);  // heights tell the two turns apart
  EXPECT_EQ(check_mesh(spiral).boundary_edges, 12u);
  EXPECT_THAT(refusal(spiral), HasSubstr("star-shaped"));
}

TEST(ExtendOpenSheet, RefusesBadArguments) {
  std::string reason;
  for (const double apron : {0.0, -1.0, static_cast<double>(NAN)}) {
    EXPECT_THROW(extend_open_sheet(rough_sheet(), apron, reason), UsageError);
  }
  EXPECT_THROW(extend_open_sheet({}, 1, reason), InvalidInput);
}

}  // namespace surf
