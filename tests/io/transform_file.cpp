// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/transform_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/landmarks_file.h"
#include "temporary_folder.h"

namespace surf::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class SmallFiles : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    const auto path = folder_.path() / "file";
    write_text(path, text);
    return path;
  }
  test::TemporaryFolder folder_;
};
using TransformFileTest = SmallFiles;
using LandmarksFileTest = SmallFiles;

TEST_F(TransformFileTest, ComesBackToTheLastDigit) {
  TransformFile t;
  t.sem_to_afm = {1.0 / 3, -0.1, 1e6 / 7, 0.1 + 1e-17, 0.99, -3e-9};
  t.verified = false;
  t.verdict = "ambiguous: two places";
  t.notes = {{"score", "0.5"}};
  write_transform(folder_.path() / "t.json", t);
  const TransformFile back = read_transform(folder_.path() / "t.json");
  EXPECT_EQ(back.sem_to_afm, t.sem_to_afm);
  EXPECT_FALSE(back.verified);
  EXPECT_EQ(back.verdict, t.verdict);
  EXPECT_EQ(back.notes, t.notes);
}

TEST_F(TransformFileTest, SixNumbersAreEnoughAndLessIsNot) {
  const std::string begin = R"({"semsurf": "transform", "version": 1, "sem_to_afm": )";
  EXPECT_EQ(read_transform(file(begin + "[1, 0, 5, 0, 1, 7]}")).sem_to_afm, (Affine{1, 0, 5, 0, 1, 7}));
  EXPECT_THAT([&] { read_transform(file(begin + "[1, 0, 5]}")); }, ThrowsMessage<FileError>(HasSubstr("3 numbers, not 6")));
  EXPECT_THAT([&] { read_transform(file(begin + "[1, 1, 5, 1, 1, 7]}")); },
              ThrowsMessage<FileError>(AllOf(HasSubstr("sem_to_afm"), HasSubstr("onto a line"))));
  EXPECT_THAT([&] { read_transform(file(R"({"version": 1})")); }, ThrowsMessage<FileError>(HasSubstr("it is no transform")));
}

TEST_F(LandmarksFileTest, PixelsCountFromTheTopAndNanometresFromTheOrigin) {
  const LandmarkFrame sem{100, 50, 10, 10, 0, 0}, afm{20, 30, 5, 5, 1000, 2000};
  const auto pairs = read_landmarks(
      file("# by hand\nname, sem_x_px, sem_y_px, afm_x_nm, afm_y_nm\r\na, 0, 0, 1, 2\r\n\nb, 99, 49, -3.5, 4e2\n"), sem, afm);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].sem_nm, (Point2{0, 490}));
  EXPECT_EQ(pairs[0].afm_nm, (Point2{1, 2}));
  EXPECT_EQ(pairs[1].sem_nm, (Point2{990, 0}));
  EXPECT_EQ(pairs[1].afm_nm, (Point2{-3.5, 400}));
  const auto both = read_landmarks(file("sem_x_nm,sem_y_nm,afm_x_px,afm_y_px\n1,2,3,4\n"), sem, afm);
  EXPECT_EQ(both[0].afm_nm, (Point2{1015, 2125}));
}

TEST_F(LandmarksFileTest, FaultsNameTheirLine) {
  const auto read = [&](const std::string& text) { return [=, this] { read_landmarks(file(text), {}, {}); }; };
  const std::string names = "sem_x_px,sem_y_px,afm_x_px,afm_y_px\n";
  EXPECT_THAT(read(""), ThrowsMessage<FileError>(HasSubstr("it is empty")));
  EXPECT_THAT(read("x,y,u,v\n1,2,3,4\n"), ThrowsMessage<FileError>(HasSubstr("no columns for sem_x and sem_y")));
  EXPECT_THAT(read(names + "1,2,3,4\n1,two,3,4\n"), ThrowsMessage<FileError>(AllOf(HasSubstr("line 3"), HasSubstr("'two'"))));
  EXPECT_THAT(read(names + "1,2,3\n"), ThrowsMessage<FileError>(AllOf(HasSubstr("line 2"), HasSubstr("too few columns"))));
  EXPECT_THAT(read(names + "1,2,3,nan\n"), ThrowsMessage<FileError>(HasSubstr("'nan' is no number")));
}

}  // namespace
}  // namespace surf::io
