// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/sheet_solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/measure_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/thin_height_field.h"

namespace surf {
namespace {

HeightField rough() { return make_rough({41, 31, 2}, 3, 9, 5); }

/// Of the prism between sheet and base.
double volume_over(const TriangleMesh& sheet, double base_nm) {
  double volume = 0;
  for (const Triangle& t : sheet.triangles) {
    const Vec3 a = sheet.vertices_nm[t[0]], b = sheet.vertices_nm[t[1]],
               c = sheet.vertices_nm[t[2]];
    volume += 0.5 * cross(b - a, c - a).z * ((a.z + b.z + c.z) / 3 - base_nm);
  }
  return volume;
}

void expect_sound(const TriangleMesh& sheet, double base_nm) {
  const TriangleMesh solid = sheet_solid(sheet, base_nm);
  const MeshReport r = check_mesh(solid);
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_EQ(r.bounds_nm.lower_nm.z, base_nm);
  EXPECT_NEAR(measure_mesh(solid).volume_nm3, volume_over(sheet, base_nm),
              1e-9 * volume_over(sheet, base_nm));
  EXPECT_EQ(find_self_intersections(solid).pairs.size(), 0u);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    EXPECT_EQ(solid.triangles[t], sheet.triangles[t]);
}

}  // namespace

TEST(SheetSolid, ClosesHeightFieldsThickAndThin) {
  expect_sound(height_field_sheet(rough()), -40);
  expect_sound(thin_height_field(rough(), {1}).mesh, -40);
  const std::size_t thin = thin_height_field(rough(), {1}).mesh.triangles.size();
  EXPECT_LT(sheet_solid(thin_height_field(rough(), {1}).mesh, -40).triangles.size(),
            thin + 3 * 144 + 1)
      << "the base is a fan, not a copy";
}

TEST(SheetSolid, ClosesSheetsWithHolesAndRaggedRims) {
  TriangleMesh sheet = height_field_sheet(rough());
  std::erase_if(sheet.triangles, [&](const Triangle& t) {
    const Vec3 v = sheet.vertices_nm[t[0]] - sheet.vertices_nm[15 * 41 + 20];
    return std::hypot(v.x, v.y) < 9 || (std::abs(v.y) < 3 && v.x < 0);  // a hole, and a bay into it
  });
  expect_sound(sheet, -40);
  TriangleMesh holed = height_field_sheet(rough());
  std::erase_if(holed.triangles, [&](const Triangle& t) {
    const Vec3 v = holed.vertices_nm[t[0]] - holed.vertices_nm[15 * 41 + 20];
    return std::hypot(v.x, v.y) < 9;
  });
  expect_sound(holed, -40);
}

TEST(SheetSolid, JoinsTrianglesThatBringTheirOwnCorners) {
  const TriangleMesh sheet = height_field_sheet(rough());
  TriangleMesh soup;
  for (const Triangle& t : sheet.triangles)
    for (const std::uint32_t v : t) soup.vertices_nm.push_back(sheet.vertices_nm[v]);
  for (std::uint32_t v = 0; v < soup.vertices_nm.size(); v += 3)
    soup.triangles.push_back({v, v + 1, v + 2});
  const TriangleMesh solid = sheet_solid(soup, -40);
  EXPECT_TRUE(check_mesh(solid).closed_and_oriented);
  EXPECT_TRUE(
      std::equal(soup.vertices_nm.begin(), soup.vertices_nm.end(), solid.vertices_nm.begin()));
}

TEST(SheetSolid, RefusesWhatHasNoInside) {
  const TriangleMesh sheet = height_field_sheet(rough());
  EXPECT_THROW(sheet_solid(sheet_solid(sheet, -40), -50), InvalidInput) << "closed";
  TriangleMesh turned = sheet;
  std::swap(turned.triangles[7][1], turned.triangles[7][2]);
  EXPECT_THROW(sheet_solid(turned, -40), InvalidInput);
  TriangleMesh down = sheet;
  for (Triangle& t : down.triangles) std::swap(t[1], t[2]);
  EXPECT_THROW(sheet_solid(down, -40), InvalidInput) << "it faces down";
  EXPECT_THROW(sheet_solid(sheet, bounds(sheet).lower_nm.z), UsageError);
  EXPECT_THROW(sheet_solid(sheet, NAN), Error);
}

}  // namespace surf
