// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/field_words.h"

#include <gtest/gtest.h>

namespace surf {
namespace {

std::string said(const std::string& text) {
  return with_field_words(text, [](std::string_view field, std::string_view value) {
    return "<" + std::string(field) + (value.empty() ? "" : "|" + std::string(value)) + ">";
  });
}

TEST(FieldWords, SaysFieldsWithAndWithoutValues) {
  EXPECT_EQ(said("`beam.tilt`: 91 is outside. Write `beam.tilt=30deg`"),
            "<beam.tilt>: 91 is outside. Write <beam.tilt|30deg>");
  EXPECT_EQ(said("`model`, `scan.pixel_size`"), "<model>, <scan.pixel_size>");
  EXPECT_EQ(said("`physics.p2=loss=joy-luo`"), "<physics.p2|loss=joy-luo>");
  EXPECT_EQ(said("`a=`"), "<a>");
}

TEST(FieldWords, LeavesOtherTextAlone) {
  for (const char* text : {"", "nothing", "`", "``", "it`s", "`My File`", "`a..b`", "`.a`", "`a.`",
                           "`A`", "`_a`", "`a.1`", "`=1`", "--tilt", "`a b`", "`open"})
    EXPECT_EQ(said(text), text);
}

TEST(FieldWords, FindsFieldsBehindStrayBackticks) {
  EXPECT_EQ(said("what`s `beam.tilt`"), "what`s <beam.tilt>");
  EXPECT_EQ(said("`My File` `a`"), "`My File` <a>");
}

TEST(FieldWords, GivesTheLastPart) {
  EXPECT_EQ(last_part("scan.pixel_size", '-'), "pixel-size");
  EXPECT_EQ(last_part("working_distance", ' '), "working distance");
}

}  // namespace
}  // namespace surf
