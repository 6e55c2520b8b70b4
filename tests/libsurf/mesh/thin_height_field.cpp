// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/thin_height_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/mesh_height_field.h"
#include "surf/mesh/open_sheet.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

HeightField rough() { return make_rough({81, 57, 1}, 3, 9, 5); }

// The height of the field's own triangles over a place inside.
double height(const HeightField& f, double x_nm, double y_nm) {
  const double u = (x_nm - f.origin_x_nm) / f.pitch_x_nm, v = (y_nm - f.origin_y_nm) / f.pitch_y_nm;
  const int x = std::clamp(static_cast<int>(u), 0, f.z_nm.width() - 2);
  const int y = std::clamp(static_cast<int>(v), 0, f.z_nm.height() - 2);
  const double a = u - x, b = v - y;
  const double low = f.z_nm(x, y), high = f.z_nm(x + 1, y + 1);
  const double side = a > b ? f.z_nm(x + 1, y) : f.z_nm(x, y + 1);
  return a > b ? low + a * (side - low) + b * (high - side)
               : low + b * (side - low) + a * (high - side);
}

// By brute force: points all over every triangle.
double vertical_deviation(const HeightField& f, const TriangleMesh& mesh) {
  double worst = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 p = mesh.vertices_nm[t[0]], q = mesh.vertices_nm[t[1]], r = mesh.vertices_nm[t[2]];
    const int n = 4 + 4 * static_cast<int>(std::max(length(q - p), length(r - p)));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 at = p + (q - p) * (double(i) / n) + (r - p) * (double(j) / n);
        worst = std::max(worst, std::abs(height(f, at.x, at.y) - at.z));
      }
  }
  return worst;
}

double area_from_above(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 p = mesh.vertices_nm[t[0]];
    const double z = cross(mesh.vertices_nm[t[1]] - p, mesh.vertices_nm[t[2]] - p).z / 2;
    EXPECT_GT(z, 0) << "every triangle faces up";
    area += z;
  }
  return area;
}

}  // namespace

TEST(ThinHeightField, StaysWithinTheToleranceEverywhere) {
  const HeightField field = rough();
  std::size_t previous = height_field_sheet(field).triangles.size() + 1;
  for (const double tolerance : {0.02, 0.1, 0.5, 2.0}) {
    const auto [mesh, s] = thin_height_field(field, {tolerance});
    EXPECT_LE(s.deviation_nm, tolerance);
    const double measured = vertical_deviation(field, mesh);
    EXPECT_LE(measured, s.deviation_nm * (1 + 1e-12))
        << "proven for every place, not for samples only";
    EXPECT_GE(measured, 0.8 * s.deviation_nm);
    EXPECT_LE(mesh_deviation(height_field_sheet(field), mesh, {.spacing_nm = 0.2}).largest_nm(),
              tolerance);
    EXPECT_LT(s.triangles_after, previous) << "a wider tolerance takes fewer triangles";
    EXPECT_EQ(s.triangles_after, mesh.triangles.size());
    EXPECT_EQ(s.triangles_before, 2u * 81 * 57);
    previous = s.triangles_after;
  }
  EXPECT_LT(previous, 400u);
}

TEST(ThinHeightField, GivesASoundSheetOverTheSameRectangle) {
  HeightField field = rough();
  field.pitch_y_nm = 1.7;
  field.origin_x_nm = 1e5;
  const auto [mesh, s] = thin_height_field(field, {0.3});
  EXPECT_NEAR(area_from_above(mesh), 81 * 57 * 1.7, 1e-6);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.components, 1u);
  EXPECT_EQ(
      r.nonmanifold_edges + r.inconsistent_edges + r.nonmanifold_vertices + r.degenerate_triangles,
      0u);
  EXPECT_TRUE(find_self_intersections(mesh).pairs.empty());
  std::string reason;
  EXPECT_TRUE(extend_open_sheet(mesh, 10, reason)) << reason;
  for (const Vec3& v : mesh.vertices_nm)
    EXPECT_EQ(
        v.z,
        field.z_nm(static_cast<int>(std::lround((v.x - field.origin_x_nm) / field.pitch_x_nm)),
                   static_cast<int>(std::lround((v.y - field.origin_y_nm) / field.pitch_y_nm))));
}

TEST(ThinHeightField, LeavesOutWhatIsFlatAndKeepsTheLettersPlace) {
  HeightField field;  // an F, so that neither a flip nor a transposition goes unseen
  field.z_nm = Grid<double>(40, 30);
  for (int y = 5; y < 25; ++y)
    for (int x = 10; x < 25; ++x)
      if (x < 14 || y >= 21 || (y >= 13 && y < 16 && x < 20)) field.z_nm(x, y) = 10;
  const auto [mesh, s] = thin_height_field(field, {0});
  EXPECT_EQ(s.deviation_nm, 0);
  EXPECT_LT(mesh.triangles.size(), s.triangles_before / 2);
  const HeightField back = mesh_height_field(mesh, {.pitch_nm = 1});
  ASSERT_EQ(back.z_nm.width(), 40);
  for (std::size_t i = 0; i < field.z_nm.data().size(); ++i)
    EXPECT_NEAR(back.z_nm.data()[i], field.z_nm.data()[i], 1e-9);

  HeightField flat;
  flat.z_nm = Grid<double>(300, 2);
  EXPECT_EQ(thin_height_field(flat, {1}).mesh.triangles.size(), 2u);
}

TEST(ThinHeightField, GivesTheFieldItselfWhereNothingFits) {
  HeightField field = make_rough({20, 14, 1}, 5, 0.5, 3);
  const auto [mesh, s] = thin_height_field(field, {0});
  EXPECT_EQ(mesh.triangles.size(), s.triangles_before);
  EXPECT_EQ(vertical_deviation(field, mesh) > 1e-12, false);
}

TEST(ThinHeightField, RefusesWhatItCannotTake) {
  HeightField field = rough();
  EXPECT_THROW(thin_height_field(field, {-1}), UsageError);
  EXPECT_THROW(thin_height_field(field, {NAN}), UsageError);
  field.valid = Mask(field.z_nm.width(), field.z_nm.height());
  EXPECT_THROW(thin_height_field(field, {1}), InvalidInput);
}

TEST(ThinHeightField, KeepsToTheTrianglesAllowed) {
  const HeightField field = rough();
  double previous = 1e9;
  for (const std::size_t triangles : {3u, 100u, 1001u, 5000u}) {
    const auto [mesh, s] = thin_height_field(field, {0, triangles});
    EXPECT_LE(mesh.triangles.size(), triangles);
    EXPECT_GE(mesh.triangles.size(), 0.8 * static_cast<double>(triangles) - 1)
        << "and makes use of them";
    EXPECT_FALSE(s.reached);
    EXPECT_GE(s.deviation_nm * (1 + 1e-12), vertical_deviation(field, mesh)) << "proven here too";
    EXPECT_LT(s.deviation_nm, previous);
    previous = s.deviation_nm;
  }
}

TEST(ThinHeightField, SoManyTrianglesComeAsNearAsTheirToleranceDoes) {
  const HeightField field = rough();
  for (const double tolerance : {0.1, 0.5, 2.0}) {
    ThinSummary by_tolerance, by_number;
    by_tolerance = thin_height_field(field, {tolerance}).summary;
    by_number = thin_height_field(field, {0, by_tolerance.triangles_after + 2}).summary;
    EXPECT_LE(by_number.deviation_nm, 1.1 * tolerance) << by_tolerance.triangles_after;
  }
}

TEST(ThinHeightField, TheFirstOfTwoLimitsCounts) {
  const HeightField field = rough();
  ThinSummary s;
  s = thin_height_field(field, {2.0, 100'000}).summary;
  EXPECT_TRUE(s.reached);
  EXPECT_LE(s.deviation_nm, 2.0);
  EXPECT_EQ(thin_height_field(field, {2.0}).mesh.triangles.size(), s.triangles_after);
  s = thin_height_field(field, {0.02, 50}).summary;
  EXPECT_FALSE(s.reached);
  EXPECT_GT(s.deviation_nm, 0.02);
  s = thin_height_field(field, {0, 1'000'000}).summary;
  EXPECT_TRUE(s.reached) << "all of it: nothing is left out";
  EXPECT_THROW(thin_height_field(field, {0, 1}), UsageError);
}

}  // namespace surf
