// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/height_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

using testing::HasSubstr;

HeightField small_field() {
  HeightField field;
  field.z_nm = Grid<double>(3, 2, 1.0);
  return field;
}

std::string complaint(const HeightField& field) {
  try {
    validate(field, "scan.gwy");
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.subject(), "scan.gwy");
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

}  // namespace

TEST(HeightField, CoordinatesStartAtTheOrigin) {
  HeightField field = small_field();
  field.pitch_x_nm = 2;
  field.pitch_y_nm = 3;
  field.origin_x_nm = 10;
  field.origin_y_nm = -5;
  EXPECT_EQ(field.x_nm(2), 14);
  EXPECT_EQ(field.y_nm(1), -2);
}

TEST(HeightField, AcceptsASoundField) { EXPECT_EQ(complaint(small_field()), ""); }

TEST(HeightField, RefusesFewerThanTwoSamples) {
  HeightField field = small_field();
  field.z_nm = Grid<double>(5, 1);
  EXPECT_THAT(complaint(field), HasSubstr("5 x 1 samples"));
  field.z_nm = Grid<double>(1, 5);
  EXPECT_THAT(complaint(field), HasSubstr("1 x 5 samples"));
  field.z_nm = Grid<double>();
  EXPECT_THAT(complaint(field), HasSubstr("0 x 0 samples"));
}

TEST(HeightField, RefusesBadPitches) {
  for (const double pitch : {0.0, -1.0, static_cast<double>(NAN), HUGE_VAL, 1e61, 1e-61}) {
    HeightField field = small_field();
    field.pitch_x_nm = pitch;
    EXPECT_THAT(complaint(field), HasSubstr("pitch along x"));
    field = small_field();
    field.pitch_y_nm = pitch;
    EXPECT_THAT(complaint(field), HasSubstr("pitch along y"));
  }
}

TEST(HeightField, RefusesAnOriginThatIsNotFinite) {
  HeightField field = small_field();
  field.origin_y_nm = NAN;
  EXPECT_THAT(complaint(field), HasSubstr("origin"));
}

TEST(HeightField, RefusesAMaskOfAnotherSize) {
  HeightField field = small_field();
  field.valid = Mask(2, 3, 1);
  EXPECT_THAT(complaint(field), HasSubstr("mask has 2 x 3"));
  field.valid = Mask(3, 3, 1);
  EXPECT_THAT(complaint(field), HasSubstr("mask has 3 x 3"));
}

TEST(HeightField, NamesTheHeightThatIsNotFinite) {
  HeightField field = small_field();
  field.z_nm(2, 1) = NAN;
  EXPECT_THAT(complaint(field), HasSubstr("column 2, row 1"));
}

TEST(HeightField, RefusesHeightsWhosePowersOverflow) {
  HeightField field = small_field();
  field.z_nm(1, 0) = -1e61;
  EXPECT_THAT(complaint(field), HasSubstr("column 1, row 0 is -1e+61"));
  field.z_nm(1, 0) = -1e60;
  EXPECT_EQ(complaint(field), "");
  field.origin_x_nm = 1e61;
  EXPECT_THAT(complaint(field), HasSubstr("origin"));
}

TEST(HeightField, InvalidSamplesNeedNoHeight) {
  HeightField field = small_field();
  field.z_nm(2, 1) = NAN;
  field.valid = Mask(3, 2, 1);
  EXPECT_NE(complaint(field), "");
  field.valid(2, 1) = 0;
  EXPECT_EQ(complaint(field), "");
}

}  // namespace surf
