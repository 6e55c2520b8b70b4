// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/transform_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/io/files.h"
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
  EXPECT_EQ(read_transform(file(begin + "[1, 0, 5, 0, 1, 7]}")).sem_to_afm,
            (Affine{1, 0, 5, 0, 1, 7}));
  EXPECT_THAT([&] { read_transform(file(begin + "[1, 0, 5]}")); },
              ThrowsMessage<FileError>(HasSubstr("3 numbers, not 6")));
  EXPECT_THAT([&] { read_transform(file(begin + "[1, 1, 5, 1, 1, 7]}")); },
              ThrowsMessage<FileError>(AllOf(HasSubstr("sem_to_afm"), HasSubstr("onto a line"))));
  EXPECT_THAT([&] { read_transform(file(R"({"version": 1})")); },
              ThrowsMessage<FileError>(HasSubstr("it is no transform")));
}

}  // namespace
}  // namespace surf::io
