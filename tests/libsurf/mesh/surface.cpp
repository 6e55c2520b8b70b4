// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/surface.h"

#include <gtest/gtest.h>

namespace surf {

TEST(ScalarName, IsLowerCaseWithALetterFirst) {
  for (const char* good : {"height", "a", "se_stderr", "a__1_"})
    EXPECT_TRUE(is_scalar_name(good)) << good;
  for (const char* bad : {"", "Height", "_a", "1a", "a b", "a-b", "\xc3\xa4"})
    EXPECT_FALSE(is_scalar_name(bad)) << bad;
}

TEST(ScalarName, OfAnyTextHasThatForm) {
  EXPECT_EQ(scalar_name("Elevation (nm)"), "elevation_nm");
  EXPECT_EQ(scalar_name("_HEIGHT NM"), "height_nm");
  EXPECT_EQ(scalar_name("SE.stderr"), "se_stderr");
  EXPECT_EQ(scalar_name("2nd"), "scalar_2nd");
  EXPECT_EQ(scalar_name("--"), "scalar");
  EXPECT_EQ(scalar_name("a__1_"), "a__1_") << "as it is";
  for (const char* text : {"", "\xc3\xa4", "9", "A B", "__x"})
    EXPECT_TRUE(is_scalar_name(scalar_name(text))) << text;
}

}  // namespace surf
