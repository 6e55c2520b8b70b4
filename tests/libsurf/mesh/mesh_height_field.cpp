// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/mesh_height_field.h"

#include <gtest/gtest.h>

#include "mesh_test.h"
#include "surf/core/error.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

/// The letter F: it shows every flip and transposition.
HeightField letter_f() {
  HeightField field;
  field.z_nm = Grid<double>(4, 5);
  field.z_nm.data() = {5, 0, 0, 0,  //
                       5, 0, 0, 0,  //
                       5, 5, 5, 0,  //
                       5, 0, 0, 0,  //
                       5, 5, 5, 6};
  field.pitch_x_nm = field.pitch_y_nm = 2;
  field.origin_x_nm = 10;
  field.origin_y_nm = -20;
  return field;
}

}  // namespace

TEST(MeshHeightField, GivesAFieldBack) {
  for (const TriangleMesh& mesh :
       {height_field_sheet(letter_f()), height_field_solid(letter_f(), -9)}) {
    const HeightField field = mesh_height_field(mesh, {.pitch_nm = 2});
    EXPECT_EQ(field.origin_x_nm, 10);
    EXPECT_EQ(field.origin_y_nm, -20);
    EXPECT_EQ(field.pitch_x_nm, 2);
    EXPECT_TRUE(field.valid.empty());
    ASSERT_EQ(field.z_nm.width(), 4);
    ASSERT_EQ(field.z_nm.height(), 5);
    EXPECT_EQ(field.z_nm, letter_f().z_nm);
  }
}

TEST(MeshHeightField, GivesARoughFieldBackWithinRounding) {
  const HeightField field = make_rough({127, 63, 1}, 5, 4, 2);
  const HeightField back = mesh_height_field(height_field_sheet(field), {.pitch_nm = 1});
  ASSERT_EQ(back.z_nm.size(), field.z_nm.size());
  for (std::size_t i = 0; i < field.z_nm.size(); ++i) {
    EXPECT_NEAR(back.z_nm.data()[i], field.z_nm.data()[i], 1e-9);
  }
}

TEST(MeshHeightField, TakesTheHighestPointAndMarksHoles) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 10, 5);
  test::append(mesh, make_box({-2, -2, 20}, {2, 2, 21}));
  const HeightField field =
      mesh_height_field(mesh, {.pitch_nm = 1, .region_nm = Box{{-12, -12, 0}, {12, 12, 0}}});
  ASSERT_EQ(field.z_nm.width(), 25);
  EXPECT_EQ(field.z_nm(12, 12), 21) << "the box above the sphere";
  EXPECT_NEAR(field.z_nm(12 + 6, 12), 8, 0.05);
  EXPECT_FALSE(field.is_valid(0, 0));
  EXPECT_EQ(field.z_nm(0, 0), 0);
  EXPECT_TRUE(field.is_valid(12, 12));
}

TEST(MeshHeightField, ThreadsDoNotChangeTheResult) {
  const TriangleMesh sphere = make_sphere({0, 0, 0}, 50, 5);
  EXPECT_EQ(mesh_height_field(sphere, {.pitch_nm = 0.7, .threads = 1}).z_nm,
            mesh_height_field(sphere, {.pitch_nm = 0.7, .threads = 3}).z_nm);
}

TEST(MeshHeightField, RefusesBadArguments) {
  const TriangleMesh box = make_box({0, 0, 0}, {9, 9, 9});
  EXPECT_THROW(mesh_height_field(box, {.pitch_nm = 0}), UsageError);
  EXPECT_THROW(mesh_height_field(box, {.pitch_nm = 100}), UsageError);
  EXPECT_THROW(mesh_height_field(box, {.pitch_nm = 1e-6}), UsageError);
  EXPECT_THROW(mesh_height_field(box, {.pitch_nm = 1, .region_nm = Box{{5, 5, 0}, {1, 1, 0}}}),
               UsageError);
  EXPECT_THROW(mesh_height_field(box, {.pitch_nm = 1, .region_nm = Box{{50, 50, 0}, {60, 60, 0}}}),
               InvalidInput);
  EXPECT_THROW(mesh_height_field({}, {.pitch_nm = 1}), InvalidInput);
}

}  // namespace surf
