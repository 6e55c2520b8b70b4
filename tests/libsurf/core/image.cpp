// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

using testing::HasSubstr;

Image two_channels() {
  Image image;
  image.channels.push_back({"SE", "1", Grid<float>(4, 3, 0.5f)});
  image.channels.push_back({"SE.stderr", "1", Grid<float>(4, 3, 0.1f)});
  return image;
}

std::string complaint(const Image& image) {
  try {
    validate(image, "result.exr");
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.subject(), "result.exr");
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Image, FindsChannelsByTheirWholeName) {
  const Image image = two_channels();
  ASSERT_NE(image.find("SE.stderr"), nullptr);
  EXPECT_EQ(image.find("SE.stderr")->values(0, 0), 0.1f);
  EXPECT_EQ(image.find("SE"), &image.channels[0]);
  EXPECT_EQ(image.find("S"), nullptr);
  EXPECT_EQ(image.find("se"), nullptr);
}

TEST(Image, HasTheSizeOfItsChannels) {
  EXPECT_EQ(two_channels().width(), 4);
  EXPECT_EQ(two_channels().height(), 3);
  EXPECT_EQ(Image{}.width(), 0);
}

TEST(Image, AcceptsASoundImage) { EXPECT_EQ(complaint(two_channels()), ""); }

TEST(Image, RefusesAnEmptyImage) {
  EXPECT_THAT(complaint(Image{}), HasSubstr("no pixels"));
  Image image;
  image.channels.push_back({"SE", "1", {}});
  EXPECT_THAT(complaint(image), HasSubstr("no pixels"));
}

TEST(Image, RefusesChannelsOfDifferentSize) {
  Image image = two_channels();
  image.channels[1].values = Grid<float>(3, 4);
  EXPECT_THAT(complaint(image), HasSubstr("'SE.stderr' has 3 x 4"));
  image.channels[1].values = Grid<float>(4, 4);
  EXPECT_THAT(complaint(image), HasSubstr("'SE.stderr' has 4 x 4"));
}

TEST(Image, RefusesNamesUsedTwiceOrEmpty) {
  Image image = two_channels();
  image.channels[1].name = "SE";
  EXPECT_THAT(complaint(image), HasSubstr("named 'SE'"));
  image.channels[1].name = "";
  EXPECT_THAT(complaint(image), HasSubstr("channel 1 has no name"));
}

TEST(Image, RefusesBadPitches) {
  Image image = two_channels();
  image.pitch_x_nm = 0;
  EXPECT_THAT(complaint(image), HasSubstr("along x"));
  image = two_channels();
  image.pitch_y_nm = NAN;
  EXPECT_THAT(complaint(image), HasSubstr("along y"));
}

}  // namespace surf
