// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/vec3.h"

#include <gtest/gtest.h>

namespace surf {

TEST(Vec3, CrossIsRightHanded) {
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
  EXPECT_EQ(cross({0, 1, 0}, {0, 0, 1}), (Vec3{1, 0, 0}));
}

TEST(Vec3, CrossIsPerpendicularToBothFactors) {
  const Vec3 a{1, -2, 3};
  const Vec3 b{4, 5, -6};
  EXPECT_EQ(dot(cross(a, b), a), 0);
  EXPECT_EQ(dot(cross(a, b), b), 0);
}

TEST(Vec3, NormalizedHasLengthOne) {
  EXPECT_DOUBLE_EQ(length(normalized({3, 4, 12})), 1);
  EXPECT_DOUBLE_EQ(normalized({3, 4, 12}).z, 12.0 / 13);
}

TEST(Vec3, IsFiniteLooksAtEveryCoordinate) {
  EXPECT_TRUE(is_finite({1, 2, 3}));
  EXPECT_FALSE(is_finite({NAN, 0, 0}));
  EXPECT_FALSE(is_finite({0, HUGE_VAL, 0}));
  EXPECT_FALSE(is_finite({0, 0, -HUGE_VAL}));
}

TEST(Box, GrowsFromNothing) {
  Box box;
  EXPECT_TRUE(box.empty());
  box.extend(Vec3{1, 5, -2});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.size_nm(), (Vec3{0, 0, 0}));
  box.extend(Vec3{3, 1, 4});
  EXPECT_EQ(box.lower_nm, (Vec3{1, 1, -2}));
  EXPECT_EQ(box.upper_nm, (Vec3{3, 5, 4}));
  EXPECT_EQ(box.center_nm(), (Vec3{2, 3, 1}));
}

TEST(Box, AnEmptyBoxAddsNothing) {
  Box box;
  box.extend(Vec3{1, 2, 3});
  box.extend(Box{});
  EXPECT_EQ(box.lower_nm, (Vec3{1, 2, 3}));
  EXPECT_EQ(box.upper_nm, (Vec3{1, 2, 3}));
}

}  // namespace surf
