// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/spot_blur.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/random.h"

namespace surf::reconstruction {
namespace {

Grid<double> random_image(std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  Grid<double> image(23, 17);
  for (double& v : image.data()) v = random.uniform();
  return image;
}

double dot(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

TEST(SpotBlur, APointGetsTheVarianceThatIsAsked) {
  for (const double variance : {-0.3, 0.0, 0.5, 2.0}) {
    Grid<double> point(41, 41);
    point(20, 20) = 1;
    const Grid<double> spot = blurred(point, variance);
    double sum = 0, along = 0, across = 0;
    for (int y = 0; y < 41; ++y)
      for (int x = 0; x < 41; ++x) {
        sum += spot(x, y);
        along += spot(x, y) * (x - 20) * (x - 20);
        across += spot(x, y) * (y - 20) * (y - 20);
      }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(along, variance, 1e-12);
    EXPECT_NEAR(across, variance, 1e-12);
  }
}

TEST(SpotBlur, IsSymmetricAndKeepsAConstantAtTheBorder) {
  const Grid<double> a = random_image(1), b = random_image(2);
  EXPECT_NEAR(dot(blurred(a, 0.7), b), dot(a, blurred(b, 0.7)), 1e-10);
  const Grid<double> constant = blurred(Grid<double>(9, 7, 3.0), 1.5);
  for (const double v : constant.data()) EXPECT_NEAR(v, 3, 1e-12);
}

TEST(SpotBlur, ItsDerivativeIsThatOfDifferences) {
  const Grid<double> image = random_image(3);
  for (const double variance : {-0.2, 0.0, 0.9}) {
    constexpr double step = 1e-5;
    const Grid<double> up = blurred(image, variance + step), down = blurred(image, variance - step),
                       derivative = change_of_blur(image, variance);
    for (std::size_t i = 0; i < image.size(); ++i)
      ASSERT_NEAR((up.data()[i] - down.data()[i]) / (2 * step), derivative.data()[i], 1e-8);
  }
}

}  // namespace
}  // namespace surf::reconstruction
