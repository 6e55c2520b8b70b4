// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/image_guides.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf::reconstruction {
namespace {

Grid<double> hills() {
  Grid<double> z(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) z(x, y) = 20 * std::sin(0.3 * x) * std::cos(0.2 * y);
  return z;
}

Grid<double> image_of(const Grid<double>& z) {
  Grid<double> out = z;
  for (double& v : out.data()) v = 500 + 3 * v + 0.1 * v * v;
  return out;
}

TEST(ImageGuides, AreOfMeanZeroAndOneWhereTheImageCounts) {
  Mask used(40, 30, 1);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 5; ++x) used(x, y) = 0;
  const Grid<double> image = image_of(hills());
  const auto guides = image_guides(hills(), 10, image, used, 1);
  ASSERT_EQ(guides.size(), 6u);
  for (const Grid<double>& guide : guides) {
    double sum = 0, squares = 0, with_image = 0;
    for (int y = 0; y < 30; ++y)
      for (int x = 5; x < 40; ++x) {
        sum += guide(x, y), squares += guide(x, y) * guide(x, y);
        with_image += guide(x, y) * image(x, y);
      }
    EXPECT_NEAR(with_image / (35 * 30), 0, 1e-6);
    EXPECT_NEAR(sum / (35 * 30), 0, 1e-9);
    EXPECT_NEAR(squares / (35 * 30), 1, 1e-9);
  }
}

TEST(ImageGuides, KnowNeitherHeightNorDirectionNorGain) {
  const Mask used(40, 30, 1);
  Grid<double> other = hills();
  for (double& v : other.data()) v = 70 - v;  // every slope the other way round
  Grid<double> image = image_of(hills());
  const auto a = image_guides(hills(), 10, image, used, 1);
  for (double& v : image.data()) v = 30 + 0.4 * v;  // another offset and gain
  const auto b = image_guides(other, 10, image, used, 1);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i)
      ASSERT_NEAR(a[k].data()[i], b[k].data()[i], 1e-9) << k;
}

TEST(ImageGuides, OfALevelSurfaceAreNone) {
  const Grid<double> level(40, 30, 12.5);
  EXPECT_TRUE(image_guides(level, 10, Grid<double>(40, 30, 500), Mask(40, 30, 1), 1).empty());
}

}  // namespace
}  // namespace surf::reconstruction
