// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surf {
namespace {

using testing::ElementsAre;

TEST(Words, AreSplitAtSeparators) {
  EXPECT_THAT(split("a,b", ","), ElementsAre("a", "b"));
  EXPECT_THAT(split("2nmx3nmX", "xX"), ElementsAre("2nm", "3nm", ""));
  EXPECT_THAT(split(",", ","), ElementsAre("", ""));
  EXPECT_THAT(split("", ","), ElementsAre(""));
}

TEST(Words, AreAsFarApartAsLettersChange) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("--energy", "--enrgy"), 1u);
  EXPECT_EQ(edit_distance("same", "same"), 0u);
}

TEST(Words, AreQuotedWhereAShellWouldReadMore) {
  EXPECT_EQ(quoted_command({"semsurf", "-o", "a=1,2.tif"}), "semsurf -o a=1,2.tif");
  EXPECT_EQ(quoted_command({"my file", "", "it's", "$x"}), "'my file' '' 'it'\\''s' '$x'");
}

}  // namespace
}  // namespace surf
