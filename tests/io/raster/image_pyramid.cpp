// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>

#include "io_test.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

using test::content_of;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr int width = 301, height = 517;  // neither even nor whole tiles

Image some_image() {
  Image image;
  Grid<float> values(width, height), labels(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      values(x, y) = static_cast<float>((x * 7919 + y * 104729) % 1009) / 8;
      labels(x, y) = static_cast<float>((x + y) % 3);
    }
  values(10, height - 1) = std::numeric_limits<float>::quiet_NaN();
  for (int y = 2; y < 4; ++y)
    for (int x = 4; x < 6; ++x) values(x, height - 1 - y) = std::numeric_limits<float>::infinity();
  image.channels = {{"SE", "1", values}, {"material", "1", labels}, {"SE.stderr", "1", values}};
  image.pitch_x_nm = 2;
  image.pitch_y_nm = 3;
  image.origin_x_nm = -10;
  image.origin_y_nm = 100;
  image.metadata["beam.energy_ev"] = "1000";
  return image;
}

ImageWriteOptions in_tiles() {
  return {.channel = {}, .layout = Layout::tiles, .labels = {"material"}};
}

// Level 1 after its definition, by rows from the top.
float expected_mean(const Grid<float>& whole, int x, int row) {
  double sum = 0;
  int count = 0;
  for (int r = 2 * row; r < std::min(2 * row + 2, whole.height()); ++r)
    for (int c = 2 * x; c < std::min(2 * x + 2, whole.width()); ++c) {
      const float value = whole(c, whole.height() - 1 - r);
      if (!std::isfinite(value)) continue;
      sum += value;
      ++count;
    }
  return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
}

class ImagePyramid : public testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file(const std::string& stem) const {
    return folder_.path() / (stem + GetParam());
  }
  TemporaryFolder folder_;
};

void expect_same_values(const Grid<float>& a, const Grid<float>& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(b.data()[i])) ASSERT_TRUE(std::isnan(a.data()[i])) << i;
    else ASSERT_EQ(a.data()[i], b.data()[i]) << i;
  }
}

TEST_P(ImagePyramid, TheImageItselfIsThatOfRows) {
  const Image image = some_image();
  write_image(file("rows"), image, {.layout = Layout::rows});
  write_image(file("tiles"), image, in_tiles());
  EXPECT_EQ(test::files_in(folder_.path()), 2);
  const Image rows = read_image(file("rows")), tiles = read_image(file("tiles"));
  EXPECT_EQ(tiles.metadata, rows.metadata);
  EXPECT_EQ(tiles.pitch_x_nm, 2);
  EXPECT_EQ(tiles.origin_y_nm, 100);
  ASSERT_EQ(tiles.channels.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(tiles.channels[c].name, image.channels[c].name);
    EXPECT_EQ(tiles.channels[c].unit, rows.channels[c].unit);
    expect_same_values(tiles.channels[c].values, image.channels[c].values);
  }
}

TEST_P(ImagePyramid, LevelsAreMeansOfWhatIsFinite) {
  const Image image = some_image();
  write_image(file("f"), image, in_tiles());
  Image whole = image;
  for (int level = 1; level <= 2; ++level) {
    const Image half = read_image(file("f"), level);
    ASSERT_EQ(half.width(), (whole.width() + 1) / 2);
    ASSERT_EQ(half.height(), (whole.height() + 1) / 2);
    ASSERT_EQ(half.channels.size(), 3u);
    for (int y = 0; y < half.height(); ++y)
      for (int x = 0; x < half.width(); ++x) {
        const int row = half.height() - 1 - y;
        for (const std::size_t c : {0u, 2u}) {
          const float expected = expected_mean(whole.channels[c].values, x, row);
          const float got = half.channels[c].values(x, y);
          if (std::isnan(expected)) ASSERT_TRUE(std::isnan(got));
          else ASSERT_EQ(got, expected) << x << " " << y;
        }
        ASSERT_EQ(half.channels[1].values(x, y),
                  whole.channels[1].values(2 * x, whole.height() - 1 - 2 * row));
      }
    whole = half;
  }
}

TEST_P(ImagePyramid, LevelsAreInTheSamePlace) {
  const Image image = some_image();
  write_image(file("f"), image, in_tiles());
  const Image half = read_image(file("f"), 1), quarter = read_image(file("f"), 2);
  EXPECT_EQ(half.pitch_x_nm, 4);
  EXPECT_EQ(half.pitch_y_nm, 6);
  EXPECT_EQ(quarter.pitch_y_nm, 12);
  // The left and the upper edge.
  for (const Image* level : {&half, &quarter}) {
    EXPECT_DOUBLE_EQ(level->origin_x_nm - level->pitch_x_nm / 2, -11);
    EXPECT_DOUBLE_EQ(level->origin_y_nm + (level->height() - 0.5) * level->pitch_y_nm,
                     100 + (height - 0.5) * 3);
  }
  EXPECT_EQ(quarter.metadata.at("beam.energy_ev"), "1000");
}

TEST_P(ImagePyramid, TheLargestLevelWithinALimitIsFound) {
  write_image(file("f"), some_image(), in_tiles());
  const auto level_of = [&](std::int64_t most) { return read_image_within(file("f"), most).level; };
  EXPECT_EQ(level_of(width * height), 0);
  EXPECT_EQ(level_of(width * height - 1), 1);
  EXPECT_EQ(level_of(151 * 259), 1);
  EXPECT_EQ(level_of(151 * 259 - 1), 2);
  const ImageLevel smallest = read_image_within(file("f"), 1);
  EXPECT_EQ(smallest.level, smallest.levels - 1);
  EXPECT_EQ(smallest.whole.width, width);
  EXPECT_EQ(smallest.whole.height, height);
  EXPECT_THAT(test::complaint<UsageError>([&] { read_image(file("f"), 99); }),
              HasSubstr("no level 99"));
  write_image(file("rows"), some_image());
  const ImageLevel all = read_image_within(file("rows"), 1);  // has no other
  EXPECT_EQ(all.levels, 1);
  EXPECT_EQ(all.image.width(), width);
  EXPECT_THAT(test::complaint<UsageError>([&] { read_image(file("rows"), 1); }),
              HasSubstr("no pyramid"));
}

TEST_P(ImagePyramid, TheSameBytesEachTime) {
  write_image(file("first"), some_image(), in_tiles());
  write_image(file("second"), some_image(), in_tiles());
  EXPECT_TRUE(content_of(file("first")) == content_of(file("second")));
}

TEST_P(ImagePyramid, OnePixelAndOneTileHaveNoOtherSize) {
  Image image;
  image.channels = {{"SE", "1", Grid<float>(1, 1, 0.5f)}};
  write_image(file("one"), image, in_tiles());
  const ImageLevel one = read_image_within(file("one"), 1);
  EXPECT_EQ(one.levels, 1);
  EXPECT_EQ(one.image.channels.at(0).values(0, 0), 0.5f);
}

TEST_P(ImagePyramid, TruncationsAreRefused) {
  write_image(file("f"), some_image(), in_tiles());
  const int levels = read_image_within(file("f"), 1).levels;
  const std::string content = content_of(file("f"));
  for (std::size_t size = 0; size < content.size() - 8; size += content.size() / 37) {
    SCOPED_TRACE(size);
    test::write(file("cut"), content.substr(0, size));
    test::complaint<FileError>([&] {
      for (int level = 0; level < levels; ++level) read_image(file("cut"), level);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(All, ImagePyramid, testing::Values(".exr", ".tif"),
                         [](const auto& suite) { return suite.param + 1; });

TEST(ImagePyramidForOthers, TiffHasChannelsFirstAndMarksSmallerSizes) {
  const TemporaryFolder folder;
  write_image(folder.path() / "f.tif", some_image(), in_tiles());
  const auto input = OIIO::ImageInput::open((folder.path() / "f.tif").string());
  ASSERT_TRUE(input);
  for (int page = 0; page < 3; ++page) {
    ASSERT_TRUE(input->seek_subimage(page, 0));
    EXPECT_EQ(input->spec().width, width);
    EXPECT_EQ(input->spec().tile_width, 128);
    EXPECT_EQ(input->spec().get_int_attribute("tiff:subfiletype", 0), 0);
  }
  ASSERT_TRUE(input->seek_subimage(3, 0));
  EXPECT_EQ(input->spec().width, 151);
  EXPECT_EQ(input->spec().get_int_attribute("tiff:subfiletype", 0), 1);
  ASSERT_TRUE(input->seek_subimage(4, 0));
  EXPECT_EQ(input->spec().width, 76);
}

TEST(ImagePyramidForOthers, ExrHasLevelsDownToOnePixel) {
  const TemporaryFolder folder;
  write_image(folder.path() / "f.exr", some_image(), in_tiles());
  const auto input = OIIO::ImageInput::open((folder.path() / "f.exr").string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().tile_width, 128);
  ASSERT_TRUE(input->seek_subimage(0, 1));
  EXPECT_EQ(input->spec().width, 151);
  ASSERT_TRUE(input->seek_subimage(0, 10));
  EXPECT_EQ(input->spec().height, 1);
  EXPECT_FALSE(input->seek_subimage(0, 11));
}

}  // namespace
}  // namespace surf::io
