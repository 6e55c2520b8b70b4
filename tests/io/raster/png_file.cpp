// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "io_test.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

using test::image_of_f;
using test::TemporaryFolder;

/// Grey levels as stored, from the top.
std::vector<int> grey_levels(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  EXPECT_TRUE(input);
  EXPECT_EQ(input->spec().nchannels, 1);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> levels(static_cast<std::size_t>(input->spec().image_pixels()));
  EXPECT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, levels.data()));
  return {levels.begin(), levels.end()};
}

std::vector<int> levels_of(const Image& image, const std::string& channel = {}) {
  const TemporaryFolder folder;
  write_image(folder.path() / "a.png", image, {channel});
  return grey_levels(folder.path() / "a.png");
}

Image row(std::vector<float> values) {
  Image image;
  image.channels = {{"SE", "1", Grid<float>(static_cast<int>(values.size()), 1)}};
  image.channels[0].values.data() = std::move(values);
  return image;
}

TEST(PngFile, ShowsTheLetterUpright) {
  std::vector<int> expected;
  for (const char c : std::string("....."
                                  ".###."
                                  ".#..."
                                  ".##.."
                                  ".#..."
                                  ".#..."
                                  "o....")) {
    expected.push_back(c == '#' ? 255 : c == 'o' ? 85 : 0);
  }
  EXPECT_EQ(levels_of(image_of_f()), expected);
}

TEST(PngFile, ShowsTheChosenChannel) {
  const std::vector<int> levels = levels_of(image_of_f(), "A_z");  // -2 times the letter
  EXPECT_EQ(levels.at(0), 255);
  EXPECT_EQ(levels.at(6), 0);
}

TEST(PngFile, StretchesBetweenPercentiles) {
  std::vector<float> values(1001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  values[1000] = 1e9f;
  const std::vector<int> levels = levels_of(row(values));
  EXPECT_EQ(levels.at(5), 0);  // 0.5 percent
  EXPECT_EQ(levels.at(7), 1);
  EXPECT_EQ(levels.at(500), 128);
  EXPECT_EQ(levels.at(992), 254);
  EXPECT_EQ(levels.at(995), 255);  // 99.5 percent
  EXPECT_EQ(levels.at(1000), 255);
}

TEST(PngFile, InvalidPixelsAreBlackAndDoNotCount) {
  Image image = row({1, 2, 3, 100, -50, std::nanf("")});
  image.channels.push_back({"valid", "1", Grid<float>(6, 1, 1.0f)});
  image.channels[1].values(3, 0) = 0;
  image.channels[1].values(4, 0) = 0;
  EXPECT_EQ(levels_of(image), (std::vector<int>{0, 128, 255, 0, 0, 0}));
  EXPECT_EQ(levels_of(image, "valid"), (std::vector<int>{255, 255, 255, 0, 0, 255}));
}

TEST(PngFile, ConstantImagesAreGrey) {
  EXPECT_EQ(levels_of(row({7, 7, 7})), (std::vector<int>{128, 128, 128}));
  const float nan = std::nanf("");
  EXPECT_EQ(levels_of(row({nan, nan})), (std::vector<int>{0, 0}));
  // One pixel in a thousand stands out: the percentiles coincide, the extremes do not.
  std::vector<float> values(1000, 1.0f);
  values[10] = 2;
  EXPECT_EQ(levels_of(row(values)).at(10), 255);
  EXPECT_EQ(levels_of(row(values)).at(11), 0);
  const float large = 3e38f;
  EXPECT_EQ(levels_of(row({-large, 0, large})), (std::vector<int>{0, 128, 255}));
}

TEST(PngFile, ReadsBackWhatEightBitsCanHold) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.png";
  const Image image = image_of_f();
  write_image(path, image, {"BSE.stderr"});
  const Image read = read_image(path);
  ASSERT_EQ(read.channels.size(), 1u);
  EXPECT_EQ(read.channels[0].name, "BSE.stderr");
  EXPECT_EQ(read.channels[0].unit, "1");
  EXPECT_EQ(read.pitch_y_nm, image.pitch_y_nm);
  EXPECT_EQ(read.origin_x_nm, image.origin_x_nm);
  EXPECT_EQ(read.metadata.at("title"), image.metadata.at("title"));
  EXPECT_NEAR(std::stod(read.metadata.at("png.stretch_low")), -1.999, 1e-6);
  EXPECT_NEAR(std::stod(read.metadata.at("png.stretch_high")), -0.499, 1e-6);
  for (std::size_t i = 0; i < read.channels[0].values.size(); ++i) {
    EXPECT_NEAR(read.channels[0].values.data()[i], image.channels[1].values.data()[i], 1.5 / 255);
  }
}

TEST(PngFile, WritesTheSameBytesEachTimeAndNoDate) {
  const TemporaryFolder folder;
  write_image(folder.path() / "a.png", image_of_f());
  write_image(folder.path() / "b.png", image_of_f());
  const std::string content = test::content_of(folder.path() / "a.png");
  EXPECT_EQ(content, test::content_of(folder.path() / "b.png"));
  for (const char* word : {"OpenImageIO", "Software", "tIME", "semsurf-test"}) {
    EXPECT_THAT(content, testing::Not(testing::HasSubstr(word)));
  }
}

TEST(PngFile, TruncationsAreRefused) {
  const TemporaryFolder folder;
  write_image(folder.path() / "a.png", image_of_f());
  const std::string content = test::content_of(folder.path() / "a.png");
  for (std::size_t size = 0; size < content.size() - 12; size += 17) {  // IEND takes 12 bytes
    SCOPED_TRACE(size);
    const auto cut = test::write(folder.path() / "cut.png", content.substr(0, size));
    test::complaint<FileError>([&] { read_image(cut); });
  }
}

}  // namespace
}  // namespace surf::io
