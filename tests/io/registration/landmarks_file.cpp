// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/landmarks_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

class LandmarksFile : public testing::Test {
 protected:
  std::vector<LandmarkPair> read(const std::string& text) {
    write_text(folder_.path() / "marks.csv", text);
    const PlacedImage sem{{2, 3, 10, 20}, Grid<double>(4, 4)},
        afm{{5, 5, -1, -2}, Grid<double>(4, 4)};
    return read_landmarks(folder_.path() / "marks.csv", sem, afm);
  }
  std::string failure(const std::string& text) {
    try {
      read(text);
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(LandmarksFile, HoldsNanometresInAnyOrderOfColumns) {
  const auto pairs = read(
      "# by hand\nafm_y_nm, "
      "name,sem_x_nm,sem_y_nm,afm_x_nm\r\n4,\"a,b\",1,2,+3\n\n-4,c,-1,-2.5e1,-3\n");
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].sem_nm, (Point2{1, 2}));
  EXPECT_EQ(pairs[0].afm_nm, (Point2{3, 4}));
  EXPECT_EQ(pairs[1].sem_nm, (Point2{-1, -25}));
}

TEST_F(LandmarksFile, PutsPixelsWhereTheirImageIs) {
  const auto pairs = read("sem_x_px,sem_y_px,afm_x_nm,afm_y_nm\n0,0,7,8\n1.5,2,7,8\n");
  EXPECT_EQ(pairs[0].sem_nm, (Point2{10, 20}));
  EXPECT_EQ(pairs[1].sem_nm, (Point2{13, 26}));
  EXPECT_EQ(pairs[1].afm_nm, (Point2{7, 8}));
}

TEST_F(LandmarksFile, CountsRowsFromTheTopAsViewersDo) {
  const auto pairs = read("sem_col_px,sem_row_px,afm_x_px,afm_y_px\n1,0,0,3\n0,3,0,0\n");
  EXPECT_EQ(pairs[0].sem_nm, (Point2{12, 29}));  // the top row of four
  EXPECT_EQ(pairs[1].sem_nm, (Point2{10, 20}));
  EXPECT_EQ(pairs[0].afm_nm, (Point2{-1, 13}));
  EXPECT_THAT(failure("sem_x_px,sem_row_px,afm_x_nm,afm_y_nm\n"), HasSubstr("different units"));
}

TEST_F(LandmarksFile, SaysWhereItIsWrong) {
  const std::string head = "sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm\n";
  EXPECT_THAT(failure(head + "1,2,3,4\n1,2,three,4\n"), HasSubstr("line 3: afm_x is 'three'"));
  EXPECT_THAT(failure(head + "1,2,3\n"), HasSubstr("line 2: afm_y is missing"));
  EXPECT_THAT(failure(head + "1,2,3,nan\n"), HasSubstr("no finite number"));
  EXPECT_THAT(failure(head), HasSubstr("no pairs"));
  EXPECT_THAT(failure(""), HasSubstr("no pairs"));
  EXPECT_THAT(failure("sem_x_nm,sem_y_nm,afm_x_nm\n"), HasSubstr("no column afm_y_nm"));
  EXPECT_THAT(failure("sem_x_nm,sem_y_px,afm_x_nm,afm_y_nm\n"), HasSubstr("different units"));
  EXPECT_THAT(failure("sem_x_nm,sem_x_px,sem_y_nm,afm_x_nm,afm_y_nm\n"),
              HasSubstr("two columns of sem_x"));
}

}  // namespace
}  // namespace surf::io
