// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/sample_image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf {
namespace {

PlacedImage ramp() {
  PlacedImage image;
  image.values = Grid<double>(4, 3);
  image.pitch_x_nm = 2, image.pitch_y_nm = 5, image.origin_x_nm = 10, image.origin_y_nm = -5;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) image.values(x, y) = 100 + 3 * x + 7 * y + x * y;
  return image;
}

TEST(SampleImage, IsBilinearAndExactAtSamples) {
  const PlacedImage image = ramp();
  EXPECT_EQ(sample_image(image, image.place_nm(3, 2)), image.values(3, 2));
  EXPECT_EQ(sample_image(image, image.place_nm(0, 0)), 100);
  EXPECT_DOUBLE_EQ(sample_image(image, image.place_nm(1.25, 0.5)),
                   100 + 3 * 1.25 + 7 * 0.5 + 1.25 * 0.5);
}

TEST(SampleImage, KnowsNothingOutsideAndBesideHoles) {
  PlacedImage image = ramp();
  EXPECT_TRUE(std::isnan(sample_image(image, image.place_nm(3.01, 1))));
  EXPECT_TRUE(std::isnan(sample_image(image, image.place_nm(1, -0.01))));
  image.valid = Mask(4, 3, 1);
  image.valid(1, 1) = 0;
  EXPECT_TRUE(std::isnan(sample_image(image, image.place_nm(0.5, 0.5))));
  EXPECT_FALSE(std::isnan(
      sample_image(image, image.place_nm(0, 0.5))));  // beside it, but the hole does not count
}

}  // namespace
}  // namespace surf
