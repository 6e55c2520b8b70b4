// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/specimen.h"

#include <limits>

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"
#include "surf/mc/geometry/largest_length.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using testing::AllOf;
using testing::HasSubstr;

Specimen with(TriangleMesh mesh) {
  Specimen s;
  s.materials = {io::find_material("Si", "test")};
  s.bodies.push_back({"part.stl", std::move(mesh), 0});
  return s;
}

std::string complaint(const Specimen& s) {
  try {
    validate(s);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(Specimen, AcceptsClosedBodies) {
  EXPECT_EQ(complaint(with(make_box({0, 0, 0}, {1, 2, 3}))), "");
}

TEST(Specimen, ReachesNoFartherThanTheLargestLength) {
  const double most = largest_length_nm;
  EXPECT_EQ(complaint(with(make_box({-most, -most, -most}, {most, most, most}))), "");
  for (const double far : {1.001 * most, 1e19, 1e300}) {
    EXPECT_THAT(complaint(with(make_box({0, 0, 0}, {1, far, 1}))),
                AllOf(HasSubstr("part.stl: it reaches"), HasSubstr("specimen.unit")));
    EXPECT_THAT(complaint(with(make_box({-far, 0, 0}, {1, 1, 1}))),
                HasSubstr("part.stl: it reaches"));
    Specimen substrate = with(make_box({0, 0, 0}, {1, 1, 1}));
    substrate.substrate = Substrate{0, -far};
    EXPECT_THAT(complaint(substrate), HasSubstr("specimen.substrate_z"));
    Specimen field;
    field.materials = {io::find_material("Si", "test")};
    field.height_field = HeightFieldBody{"scan.gsf", {}, 0, Edge::mirror};
    field.height_field->field.z_nm = Grid<double>(3, 3);
    EXPECT_EQ(complaint(field), "");
    const double far_samples = std::min(far, 1e50);  // what a height field may hold
    field.height_field->field.pitch_x_nm = far_samples;
    EXPECT_THAT(complaint(field), HasSubstr("scan.gsf: it reaches"));
    field.height_field->field.pitch_x_nm = 1;
    field.height_field->field.z_nm(1, 1) = far_samples;
    EXPECT_THAT(complaint(field), HasSubstr("scan.gsf: it reaches"));
  }
}

TEST(Specimen, RefusesOpenMeshesWithThePlace) {
  TriangleMesh mesh = make_box({0, 0, 0}, {10, 10, 10});
  mesh.triangles.pop_back();
  const std::string why = complaint(with(mesh));
  EXPECT_THAT(why, HasSubstr("part.stl"));
  EXPECT_THAT(why, HasSubstr("open"));
  EXPECT_THAT(why, HasSubstr("3 of its edges"));
  EXPECT_THAT(why, HasSubstr("top of a half-space: "));
  EXPECT_THAT(why, HasSubstr("semsurf mesh part.stl --repair -o part_repaired.ply"));
}

TEST(Specimen, TakesSheetsForHalfSpaces) {
  const Specimen s = with(height_field_sheet(make_mesa({}, 100, 50, 20)));
  EXPECT_EQ(complaint(s), "");
  EXPECT_TRUE(is_sheet(s.bodies[0]));
  EXPECT_FALSE(is_sheet(with(make_box({0, 0, 0}, {1, 1, 1})).bodies[0]));
}

TEST(Specimen, RefusesMixedOrientation) {
  TriangleMesh mesh = make_box({0, 0, 0}, {10, 10, 10});
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_THAT(complaint(with(mesh)), HasSubstr("face opposite ways"));
}

TEST(Specimen, RefusesBodiesThinnerThanInterfaces) {
  EXPECT_EQ(complaint(with(make_box({0, 0, 0}, {10, 10, 0.011}))), "");
  EXPECT_THAT(complaint(with(make_box({0, 0, 0}, {10, 10, 0.009}))),
              HasSubstr("only 0.009 nm thick"));
}

TEST(Specimen, RefusesNaNEmptinessAndWrongNumbers) {
  TriangleMesh mesh = make_box({0, 0, 0}, {10, 10, 10});
  mesh.vertices_nm[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint(with(mesh)), HasSubstr("part.stl"));
  EXPECT_THAT(complaint(with({})), HasSubstr("part.stl"));
  EXPECT_THAT(complaint({}), HasSubstr("nothing in it"));
  Specimen s = with(make_box({0, 0, 0}, {1, 1, 1}));
  s.bodies[0].material = 3;
  EXPECT_THAT(complaint(s), HasSubstr("material number 3"));
}

TEST(Specimen, ExtentIsOfBodiesAndFields) {
  Specimen s = with(make_box({-1, -2, -3}, {4, 5, 6}));
  EXPECT_EQ(extent(s).lower_nm, (Vec3{-1, -2, -3}));
  EXPECT_EQ(extent(s).upper_nm, (Vec3{4, 5, 6}));
  EXPECT_EQ(extent(test::flat("Si")).size_nm().x, 1000);
}

TEST(Material, RefusesWhatCannotBe) {
  Material m = io::find_material("Si", "test");
  m.density_g_cm3 = -1;
  EXPECT_THROW(validate(m), InvalidInput);
  m = io::find_material("Si", "test");
  m.constituents[0].weight_fraction = 0.9;
  EXPECT_THROW(validate(m), InvalidInput);
  m = io::find_material("Si", "test");
  m.loss_join_ev = 4;
  EXPECT_THROW(validate(m), InvalidInput);
  m = io::find_material("SiO2", "test");
  m.formula_weight_g_mol = 0;
  EXPECT_THROW(validate(m), InvalidInput);
}

}  // namespace surf::mc
