// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "surf/core/error.h"

namespace surf {
namespace {

using Values = std::vector<double>;

TEST(ImageError, IsRelativeToThePixelDownToATenthOfTheMean) {
  const Values reference{1, 3, 0, 4},
      values{1.1, 3, 0.02, 3.6};  // mean 2: the dark one counts as 0.2
  const ImageError e = image_error(values, {}, reference, {});
  EXPECT_EQ(e.pixels, 4);
  EXPECT_DOUBLE_EQ(e.mean_signal, 2);
  EXPECT_NEAR(e.mean, 0.3 / 4, 1e-12);
  EXPECT_NEAR(e.rms, std::sqrt(0.03 / 4), 1e-12);
  EXPECT_NEAR(e.largest, 0.1, 1e-12);
  EXPECT_NEAR(e.percentile95, 0.1, 1e-12);
  EXPECT_NEAR(e.bias, (0.1 + 0.02 - 0.4) / 4 / 2, 1e-12);
  EXPECT_EQ(e.noise, 0);
  EXPECT_NEAR(e.beyond_noise, e.rms, 1e-12);
}

TEST(ImageError, NoiseIsWhatStandardErrorsExplain) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Values reference, values, errors, reference_errors;
  for (int i = 0; i < 20000; ++i) {
    const double truth = 1 + 0.5 * std::sin(0.01 * i);
    errors.push_back(0.05 * truth);
    reference_errors.push_back(0.02);
    reference.push_back(truth + 0.02 * normal(random));
    values.push_back(1.1 * truth + errors.back() * normal(random));
  }
  const ImageError e = image_error(values, errors, reference, reference_errors);
  EXPECT_NEAR(e.noise, 0.05, 0.002);
  EXPECT_NEAR(e.reference_noise, 0.02, 0.006);
  EXPECT_NEAR(e.beyond_noise, 0.1, 0.002);
  EXPECT_NEAR(e.bias, 0.1, 0.002);
  const ImageError exact = image_error(reference, {}, reference, {});
  EXPECT_EQ(exact.rms, 0);
  EXPECT_EQ(exact.beyond_noise, 0);
}

TEST(ImageError, RefusesWhatCannotBeCompared) {
  const Values one{1}, two{1, 2}, none, dark{0, 0};
  const Values broken{1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(image_error(one, {}, two, {}), InvalidInput);
  EXPECT_THROW(image_error(two, one, two, {}), InvalidInput);
  EXPECT_THROW(image_error(none, {}, none, {}), InvalidInput);
  EXPECT_THROW(image_error(broken, {}, two, {}), InvalidInput);
  EXPECT_THROW(image_error(two, {}, dark, {}), InvalidInput);
}

}  // namespace
}  // namespace surf
