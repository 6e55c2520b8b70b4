// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/height_field_file.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../io_test.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

/// The F, placed unevenly, with a hole.
HeightField field_of_f() {
  HeightField field;
  const Grid<float> f = test::letter_f();
  field.z_nm = Grid<double>(f.width(), f.height());
  for (std::size_t i = 0; i < f.size(); ++i) field.z_nm.data()[i] = 10.0 * double(f.data()[i]) - 3;
  field.valid = Mask(f.width(), f.height(), 1);
  field.valid(4, 0) = 0;
  field.pitch_x_nm = 1.25;
  field.pitch_y_nm = 0.1;
  field.origin_x_nm = -100.0 / 3;
  field.origin_y_nm = 1e-7;
  return field;
}

/// Relative to the range: 32-bit floats in metres round.
void expect_same(const HeightField& field, const HeightField& expected, double tolerance) {
  EXPECT_EQ(field.pitch_x_nm, expected.pitch_x_nm);
  EXPECT_EQ(field.pitch_y_nm, expected.pitch_y_nm);
  EXPECT_EQ(field.origin_x_nm, expected.origin_x_nm);
  EXPECT_EQ(field.origin_y_nm, expected.origin_y_nm);
  ASSERT_EQ(field.z_nm.width(), expected.z_nm.width());
  ASSERT_EQ(field.z_nm.height(), expected.z_nm.height());
  for (int y = 0; y < field.z_nm.height(); ++y) {
    for (int x = 0; x < field.z_nm.width(); ++x) {
      ASSERT_EQ(field.is_valid(x, y), expected.is_valid(x, y)) << x << ", " << y;
      if (field.is_valid(x, y)) {
        EXPECT_NEAR(field.z_nm(x, y), expected.z_nm(x, y), tolerance) << x << ", " << y;
      }
    }
  }
}

class HeightFieldFormats : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == ".vti" &&
        image_library_versions().find("VTK") == std::string::npos)
      GTEST_SKIP() << "built without VTK";
  }
  std::filesystem::path file(const std::string& stem = "f") const {
    return folder_.path() / (stem + GetParam());
  }
  TemporaryFolder folder_;
};

TEST_P(HeightFieldFormats, KeepsTheF) {
  const std::map<std::string, std::string> metadata{{"semsurf.version", "1.2"},
                                                    {"title", "a=b \\ \xC3\xA9\nsecond"}};
  write_height_field(file(), field_of_f(), metadata);
  const HeightFieldFile read = read_height_field(file());
  const double tolerance = std::string(GetParam()) == ".txt" ? 0 : 1e-6;
  expect_same(read.field, field_of_f(), tolerance);
  EXPECT_EQ(read.metadata, metadata);
  EXPECT_EQ(read.channel, "z_nm");
  EXPECT_TRUE(read.notes.empty()) << read.notes.front();
  EXPECT_EQ(test::files_in(folder_.path()), 1);
}

TEST_P(HeightFieldFormats, WritesTheSameBytesEachTime) {
  write_height_field(file("one"), field_of_f(), {{"a", "b"}});
  write_height_field(file("two"), field_of_f(), {{"a", "b"}});
  EXPECT_EQ(test::content_of(file("one")), test::content_of(file("two")));
}

TEST_P(HeightFieldFormats, AllHolesAreRefused) {
  HeightField field = field_of_f();
  field.valid = Mask(5, 7);
  write_height_field(file(), field);
  EXPECT_THAT(test::complaint<InvalidInput>([&] { read_height_field(file()); }),
              HasSubstr("no pixel of its channel"));
}

/// Whether a text file cut off here has a last row of fewer than the five numbers of those before
/// it, or no row.
bool ends_within_a_row(const std::string& start) {
  const std::size_t line = start.rfind('\n') + 1;  // npos + 1 is 0
  const std::string last = start.substr(line);
  if (last.starts_with('#') || start.empty()) return true;
  const bool is_first = line == 0 || start[start.rfind('\n', line - 2) + 1] == '#';
  if (last.empty()) return is_first;
  return !is_first && (std::count(last.begin(), last.end(), '\t') < 4 || last.ends_with('\t'));
}

TEST_P(HeightFieldFormats, CutOffFilesAreRefused) {
  HeightField field = field_of_f();
  write_height_field(file(), field);
  const std::string content = test::content_of(file());
  const bool is_text = std::string(GetParam()) == ".txt";
  std::size_t cut = 0;
  for (std::size_t size = 0; size < content.size() - 8; size += is_text ? 1 : 13) {
    SCOPED_TRACE(size);
    // Text that ends with a row, or within its last number, is a smaller matrix or another number.
    // Elsewhere within a row it is no matrix.
    const std::string start = content.substr(0, size);
    if (is_text && !ends_within_a_row(start)) continue;
    ++cut;
    test::write(file("cut"), start);
    test::complaint<FileError>([&] { read_height_field(file("cut")); });
  }
  EXPECT_GT(cut, 10u);
}

INSTANTIATE_TEST_SUITE_P(All, HeightFieldFormats, testing::Values(".gsf", ".tif", ".txt", ".vti"),
                         [](const auto& suite) { return std::string(suite.param + 1); });

std::string gsf_of(const std::string& header, const std::vector<float>& values) {
  std::string text = "Gwyddion Simple Field 1.0\n" + header;
  text.append(4 - text.size() % 4, '\0');
  for (const float v : values) {
    auto bits = std::bit_cast<std::uint32_t>(v);
    for (int i = 0; i < 4; ++i, bits >>= 8) text += static_cast<char>(bits & 0xFF);
  }
  return text;
}

class HeightFieldText : public testing::Test {
 protected:
  HeightFieldFile read(const std::string& content, const char* name = "a.txt",
                       const HeightReadOptions& options = {}) {
    return read_height_field(test::write(folder_.path() / name, content), options);
  }
  TemporaryFolder folder_;
};

TEST_F(HeightFieldText, GsfOfOthersKeepsUnitsAndOblongPixels) {
  const auto file = read(
      gsf_of("XRes = 2\nYRes=3\nXReal = 4e-6\nYReal = 3\nXYUnits = um\nZUnits = mm\nTitle = H\n",
             {1, 2, 3, 4, 5, 6}),
      "a.gsf");
  EXPECT_DOUBLE_EQ(file.field.pitch_x_nm, 2e-3);
  EXPECT_DOUBLE_EQ(file.field.pitch_y_nm, 1e3);
  EXPECT_DOUBLE_EQ(file.field.z_nm(0, 2), 1e6);
  EXPECT_DOUBLE_EQ(file.field.z_nm(1, 0), 6e6);
  EXPECT_TRUE(file.notes.empty());
}

TEST_F(HeightFieldText, WhatIsNotSaidIsAssumedAloud) {
  const std::string gsf = gsf_of("XRes = 2\nYRes = 2\n", {1, 2, 3, 4});
  const auto plain = read(gsf, "a.gsf");
  EXPECT_EQ(plain.field.pitch_x_nm, 1);
  EXPECT_EQ(plain.notes.size(), 2u);
  const auto given = read(gsf, "a.gsf", {.z_unit_nm = 10, .pitch_x_nm = 2, .pitch_y_nm = 3});
  EXPECT_EQ(given.field.z_nm(0, 1), 10);
  EXPECT_EQ(given.field.pitch_y_nm, 3);
  EXPECT_TRUE(given.notes.empty());
}

TEST_F(HeightFieldText, CommasArePointsOnlyWhereTheyMustBe) {
  EXPECT_EQ(read("1,5 2,5\n3,5 4\n").field.z_nm(0, 1), 1.5);
  EXPECT_EQ(read("1,5;2,5\n3,5;4,25\n").field.z_nm(1, 0), 4.25);
  EXPECT_EQ(read("1,5\n2,7\n").field.z_nm(1, 1), 5);
  EXPECT_EQ(read("1.5,2.5\n3,4\n").field.z_nm(1, 1), 2.5);
  EXPECT_EQ(read("1, 2, 3\n4, 5, 6\n").field.z_nm(2, 1), 3);
}

TEST_F(HeightFieldText, BadTextNamesItsLine) {
  EXPECT_THAT(test::complaint<FileError>([&] { read("1 2\n3 4 5\n"); }),
              HasSubstr("a.txt, line 2"));
  EXPECT_THAT(test::complaint<FileError>([&] { read("1 2\n3 x\n"); }), HasSubstr("a.txt, line 2"));
  EXPECT_THAT(test::complaint<FileError>([&] { read("hello\n"); }), HasSubstr("no numbers"));
  EXPECT_THAT(test::complaint<FileError>([&] { read(""); }), HasSubstr("empty"));
  EXPECT_THAT(test::complaint<InvalidInput>([&] { read("1 2 3 4\n"); }), HasSubstr("4 x 1"));
  EXPECT_THAT(test::complaint<InvalidInput>([&] { read("nan nan\nnan nan\n"); }),
              HasSubstr("no pixel"));
}

TEST_F(HeightFieldText, SizesAreCheckedBeforeMemoryIsTaken) {
  for (const char* sizes : {"XRes = 1000000\nYRes = 1000000\n", "XRes = -1\nYRes = 2\n",
                            "XRes = 2\n", "XRes = 1e300\nYRes = 2\n", "XRes = 2.5\nYRes = 2\n"}) {
    SCOPED_TRACE(sizes);
    test::complaint<FileError>([&] { read(gsf_of(sizes, {1, 2, 3, 4}), "a.gsf"); });
  }
}

TEST_F(HeightFieldText, UnknownFormatsPointToGwyddion) {
  EXPECT_THAT(test::complaint<FileError>([&] { read("no format\x01", "a.unknown"); }),
              HasSubstr("Gwyddion"));
}

TEST_F(HeightFieldText, HeightsOfASimulatedImageAreFound) {
  Image image;
  image.pitch_x_nm = 2;
  image.metadata = {{"semsurf.version", "1"}};
  image.channels = {{"SE", "1", test::letter_f()}, {"z_nm", "nm", test::letter_f()}};
  write_image(folder_.path() / "a.exr", image);
  const auto file = read_height_field(folder_.path() / "a.exr");
  EXPECT_EQ(file.channel, "z_nm");
  EXPECT_EQ(file.field.z_nm(1, 5), 1);
  EXPECT_EQ(file.field.z_nm(0, 0), 0.5);
}

TEST(HeightFieldTargets, OtherNamesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      test::complaint<UsageError>([&] { check_height_field_target(folder.path() / "a.png"); }),
      HasSubstr(".gsf"));
  test::complaint<UsageError>([&] { write_height_field(folder.path() / "a", field_of_f()); });
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

}  // namespace
}  // namespace surf::io
