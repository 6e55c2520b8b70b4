// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/csv_line.h"

#include <gmock/gmock.h>

namespace surf::io {
namespace {

using testing::ElementsAre;

TEST(CsvLine, IsCutAtCommas) {
  EXPECT_THAT(split_csv_line("Si,1.5,,x"), ElementsAre("Si", "1.5", "", "x"));
  EXPECT_THAT(split_csv_line("Si,"), ElementsAre("Si", ""));
  EXPECT_THAT(split_csv_line(""), ElementsAre(""));
}

TEST(CsvLine, KeepsCommasBetweenQuotationMarks) {
  EXPECT_THAT(split_csv_line("\"Joy, D.\",1"), ElementsAre("Joy, D.", "1"));
  EXPECT_THAT(split_csv_line("a,\"open, to the end"), ElementsAre("a", "open, to the end"));
}

TEST(CsvLine, MayEndAsOnWindows) { EXPECT_THAT(split_csv_line("a,b\r"), ElementsAre("a", "b")); }

}  // namespace
}  // namespace surf::io
