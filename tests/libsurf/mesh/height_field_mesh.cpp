// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/height_field_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

using testing::HasSubstr;

/// A height field shaped like the letter F: it shows every flip and transposition. Rows from the
/// bottom up.
HeightField letter_f() {
  HeightField field;
  field.z_nm = Grid<double>(4, 5);
  field.z_nm.data() = {5, 0, 0, 0,  //
                       5, 0, 0, 0,  //
                       5, 5, 5, 0,  //
                       5, 0, 0, 0,  //
                       5, 5, 5, 6};
  field.pitch_x_nm = 2;
  field.pitch_y_nm = 3;
  field.origin_x_nm = 10;
  field.origin_y_nm = -20;
  return field;
}

Vec3 normal(const TriangleMesh& mesh, const Triangle& t) {
  return cross(mesh.vertices_nm[t[1]] - mesh.vertices_nm[t[0]],
               mesh.vertices_nm[t[2]] - mesh.vertices_nm[t[0]]);
}

double projected_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += 0.5 * normal(mesh, t).z;
  return area;
}

double volume_below_samples(const HeightField& field) {
  // The mean of a cell split from lower-left to upper-right weighs those two corners double.
  double sum = 0;
  for (int y = 0; y + 1 < field.z_nm.height(); ++y) {
    for (int x = 0; x + 1 < field.z_nm.width(); ++x) {
      const Grid<double>& z = field.z_nm;
      sum += (2 * z(x, y) + 2 * z(x + 1, y + 1) + z(x + 1, y) + z(x, y + 1)) / 6;
    }
  }
  return sum * field.pitch_x_nm * field.pitch_y_nm;
}

std::vector<double> row_of(const HeightField& field, int row) {
  std::vector<double> values;
  for (int x = 0; x < field.z_nm.width(); ++x) values.push_back(field.z_nm(x, row));
  return values;
}

std::vector<double> column_of(const HeightField& field, int column) {
  std::vector<double> values;
  for (int y = 0; y < field.z_nm.height(); ++y) values.push_back(field.z_nm(column, y));
  return values;
}

}  // namespace

TEST(HeightFieldSheet, HasAVertexPerSample) {
  const HeightField field = letter_f();
  const TriangleMesh mesh = height_field_sheet(field);
  ASSERT_EQ(mesh.vertices_nm.size(), 20u);
  EXPECT_EQ(mesh.vertices_nm[0], (Vec3{10, -20, 5}));
  EXPECT_EQ(mesh.vertices_nm[1], (Vec3{12, -20, 0}));
  EXPECT_EQ(mesh.vertices_nm[4], (Vec3{10, -17, 5}));
  EXPECT_EQ(mesh.vertices_nm[19], (Vec3{16, -8, 6}));
}

TEST(HeightFieldSheet, SplitsCellsFromLowerLeftToUpperRight) {
  HeightField field;
  field.z_nm = Grid<double>(2, 2);
  const TriangleMesh mesh = height_field_sheet(field);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  for (const Triangle& t : mesh.triangles) {
    const std::set<std::uint32_t> corners(t.begin(), t.end());
    EXPECT_TRUE(corners.contains(0) && corners.contains(3));
  }
}

TEST(HeightFieldSheet, FacesUpAndOnlyItsRimIsOpen) {
  const TriangleMesh mesh = height_field_sheet(letter_f());
  for (const Triangle& t : mesh.triangles) EXPECT_GT(normal(mesh, t).z, 0);
  EXPECT_DOUBLE_EQ(projected_area(mesh), 6 * 12);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.triangles, 24u);
  EXPECT_EQ(r.boundary_edges, 2u * (3 + 4));
  EXPECT_EQ(r.inconsistent_edges, 0u);
}

TEST(HeightFieldSheet, RefusesHolesAndSaysWhere) {
  HeightField field = letter_f();
  field.valid = Mask(4, 5, 1);
  EXPECT_NO_THROW(height_field_sheet(field));
  field.valid(3, 2) = 0;
  try {
    height_field_sheet(field);
    FAIL() << "a hole was accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("column 3, row 2"));
  }
  EXPECT_THROW(half_space_top(field, 10), InvalidInput);
  EXPECT_THROW(height_field_solid(field, -1), InvalidInput);
  field = letter_f();
  field.z_nm(1, 1) = NAN;
  EXPECT_THROW(height_field_sheet(field), InvalidInput);
}

TEST(ExtendHeightField, MirrorReflectsAboutTheOutermostSamples) {
  const HeightField e = extend_height_field(letter_f(), 4, 6, Edge::mirror);
  ASSERT_EQ(e.z_nm.width(), 8);
  ASSERT_EQ(e.z_nm.height(), 9);
  EXPECT_EQ(row_of(e, 0), (std::vector<double>{5, 5, 5, 5, 5, 0, 5, 5})) << "row 2, reflected";
  EXPECT_EQ(row_of(e, 6), (std::vector<double>{5, 5, 5, 5, 5, 6, 5, 5})) << "row 4 itself";
  EXPECT_EQ(row_of(e, 7), (std::vector<double>{0, 0, 5, 0, 0, 0, 0, 0})) << "row 3, reflected";
  EXPECT_EQ(column_of(e, 5), (std::vector<double>{0, 0, 0, 0, 0, 0, 6, 0, 0}));
}

TEST(ExtendHeightField, PeriodicRepeatsAfterTheNumberOfSamples) {
  const HeightField e = extend_height_field(letter_f(), 4, 6, Edge::periodic);
  EXPECT_EQ(row_of(e, 4), (std::vector<double>{5, 0, 5, 5, 5, 0, 5, 5}));
  EXPECT_EQ(column_of(e, 5), (std::vector<double>{0, 6, 0, 0, 0, 0, 6, 0, 0}));
}

TEST(ExtendHeightField, FlatKeepsTheOutermostHeight) {
  const HeightField e = extend_height_field(letter_f(), 4, 6, Edge::flat);
  EXPECT_EQ(row_of(e, 8), (std::vector<double>{5, 5, 5, 5, 5, 6, 6, 6}));
  EXPECT_EQ(column_of(e, 7), (std::vector<double>{0, 0, 0, 0, 0, 0, 6, 6, 6}));
}

TEST(ExtendHeightField, MarginsMayExceedTheFieldManyTimes) {
  const HeightField field = letter_f();
  const HeightField mirror = extend_height_field(field, 40, 60, Edge::mirror);
  const HeightField periodic = extend_height_field(field, 40, 60, Edge::periodic);
  ASSERT_EQ(mirror.z_nm.width(), 44);
  ASSERT_EQ(mirror.z_nm.height(), 45);
  for (int y = 0; y < 45; ++y) {
    for (int x = 0; x < 44; ++x) {
      int mx = x - 20;  // folded step by step, unlike the code under test
      while (mx < 0 || mx > 3) mx = mx < 0 ? -mx : 6 - mx;
      int my = y - 20;
      while (my < 0 || my > 4) my = my < 0 ? -my : 8 - my;
      ASSERT_EQ(mirror.z_nm(x, y), field.z_nm(mx, my)) << x << ' ' << y;
      ASSERT_EQ(periodic.z_nm(x, y), field.z_nm(x % 4, y % 5)) << x << ' ' << y;
    }
  }
}

TEST(ExtendHeightField, KeepsEverySampleInItsPlace) {
  const HeightField field = letter_f();
  for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
    const HeightField e = extend_height_field(field, 5, 3, edge);
    ASSERT_EQ(e.z_nm.width(), 4 + 2 * 3) << "rounded up to whole pitches";
    ASSERT_EQ(e.z_nm.height(), 5 + 2 * 1);
    EXPECT_EQ(e.x_nm(3), field.x_nm(0));
    EXPECT_EQ(e.y_nm(1), field.y_nm(0));
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 4; ++x) EXPECT_EQ(e.z_nm(x + 3, y + 1), field.z_nm(x, y));
    }
  }
}

TEST(ExtendHeightField, ZeroMarginsChangeNothing) {
  const HeightField e = extend_height_field(letter_f(), 0, 0, Edge::mirror);
  EXPECT_EQ(e.z_nm, letter_f().z_nm);
  EXPECT_EQ(e.origin_x_nm, 10);
}

TEST(ExtendHeightField, RoundingAddsNoPitch) {
  HeightField field = letter_f();
  field.pitch_x_nm = 0.1;
  EXPECT_EQ(extend_height_field(field, 0.1 + 0.2, 0, Edge::flat).z_nm.width(), 4 + 2 * 3);
}

TEST(ExtendHeightField, ContinuesTheMaskToo) {
  HeightField field = letter_f();
  field.valid = Mask(4, 5, 1);
  field.valid(0, 1) = 0;
  field.z_nm(0, 1) = NAN;
  const HeightField e = extend_height_field(field, 2, 0, Edge::periodic);
  EXPECT_FALSE(e.is_valid(1, 1));
  EXPECT_FALSE(e.is_valid(5, 1));
  EXPECT_TRUE(e.is_valid(0, 1));
}

TEST(ExtendHeightField, RefusesBadMargins) {
  for (const double margin : {-1.0, static_cast<double>(NAN), HUGE_VAL, 1e12}) {
    EXPECT_THROW(extend_height_field(letter_f(), margin, 0, Edge::flat), UsageError);
    EXPECT_THROW(extend_height_field(letter_f(), 0, margin, Edge::flat), UsageError);
  }
}

TEST(HalfSpaceTop, IsOneSheetWithoutCracks) {
  for (const double apron : {1.0, 100.0, 1e6}) {
    const TriangleMesh mesh = half_space_top(letter_f(), apron);
    for (const Triangle& t : mesh.triangles) ASSERT_GT(normal(mesh, t).z, 0);
    EXPECT_DOUBLE_EQ(projected_area(mesh), (6 + 2 * apron) * (12 + 2 * apron));
    const MeshReport r = check_mesh(mesh);
    EXPECT_EQ(r.boundary_edges, 2u * (5 + 6));
    EXPECT_EQ(r.inconsistent_edges + r.nonmanifold_edges + r.degenerate_triangles, 0u);
    EXPECT_EQ(r.components, 1u);
    // A disc: vertices - edges + triangles = 1.
    const std::size_t edges = (3 * r.triangles + r.boundary_edges) / 2;
    EXPECT_EQ(r.vertices + r.triangles, edges + 1);
  }
}

TEST(HalfSpaceTop, DrawsTheOutermostHeightsOutHorizontally) {
  const TriangleMesh mesh = half_space_top(letter_f(), 100);
  const Box box = bounds(mesh);
  EXPECT_EQ(box.lower_nm, (Vec3{-90, -120, 0}));
  EXPECT_EQ(box.upper_nm, (Vec3{116, 92, 6}));
  const auto height_at = [&](double x, double y) {
    for (const Vec3& v : mesh.vertices_nm) {
      if (v.x == x && v.y == y) return v.z;
    }
    return -1.0;
  };
  EXPECT_EQ(height_at(-90, -120), 5) << "corner";
  EXPECT_EQ(height_at(116, -120), 0) << "corner";
  EXPECT_EQ(height_at(116, 92), 6) << "corner";
  EXPECT_EQ(height_at(116, -8), 6) << "right of the top row";
  EXPECT_EQ(height_at(14, 92), 5) << "above column 2";
  EXPECT_EQ(height_at(14, -14), 5) << "a sample of the field itself";
  EXPECT_EQ(height_at(12, -17), 0) << "a sample of the field itself";
}

TEST(HalfSpaceTop, RefusesABadApron) {
  for (const double apron : {0.0, -1.0, static_cast<double>(NAN)}) {
    EXPECT_THROW(half_space_top(letter_f(), apron), UsageError);
  }
}

TEST(HeightFieldSolid, IsClosedAndHoldsTheVolumeBelowTheSamples) {
  for (const double base : {-0.5, -10.0, -1000.0}) {
    const HeightField field = letter_f();
    const MeshReport r = check_mesh(height_field_solid(field, base));
    EXPECT_TRUE(r.closed_and_oriented);
    EXPECT_EQ(r.nonmanifold_edges + r.degenerate_triangles + r.duplicate_triangles, 0u);
    EXPECT_EQ(r.vertices + r.triangles, 3 * r.triangles / 2 + 2) << "a sphere, topologically";
    EXPECT_NEAR(r.signed_volume_nm3, volume_below_samples(field) - base * 72, 1e-9);
    EXPECT_EQ(r.bounds_nm.lower_nm.z, base);
  }
}

TEST(HeightFieldSolid, TheSmallestFieldWorks) {
  HeightField field;
  field.z_nm = Grid<double>(2, 2, 1.0);
  const MeshReport r = check_mesh(height_field_solid(field, 0));
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_DOUBLE_EQ(r.signed_volume_nm3, 1);
  EXPECT_DOUBLE_EQ(r.area_nm2, 6);
}

TEST(HeightFieldSolid, RefusesABaseThatIsNotBelow) {
  for (const double base : {0.0, 3.0, static_cast<double>(NAN), -HUGE_VAL}) {
    EXPECT_THROW(height_field_solid(letter_f(), base), UsageError) << base;
  }
}

}  // namespace surf
