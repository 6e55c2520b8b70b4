// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/model_residual.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

constexpr int side = 200;

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) * std::cos(2 * M_PI * random.uniform());
}

/// An image of mean 2 with known noise, of which the model is off by `off` everywhere.
TrainingImage noisy(double noise, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  TrainingImage image;
  image.images = {Grid<float>(side, side)};
  image.standard_errors = {Grid<float>(side, side, static_cast<float>(noise))};
  for (float& v : image.images[0].data()) v = static_cast<float>(2 + noise * normal(random));
  return image;
}

TEST(ModelResidual, SubtractsTheNoise) {
  ResidualSum sum({"SE"});
  for (std::uint64_t seed : {1, 2}) sum.add({Grid<double>(side, side, 2.1)}, noisy(0.3, seed));
  const ModelResidual r = sum.residuals().at(0);
  EXPECT_EQ(r.channel, "SE");
  EXPECT_EQ(r.pixels, 2 * side * side);
  // The mean of 80,000 squares of noise scatters by 0.09 sqrt(2 / 80000) = 4.5e-4; 5 of that, and of 0.01.
  EXPECT_NEAR(r.rms * r.rms, 0.01, 0.004);
  EXPECT_NEAR(r.noise_rms, 0.3, 1e-6);
  EXPECT_NEAR(r.mean_signal, 2, 0.006);
}

TEST(ModelResidual, IsTheDeviationWhereThereIsNoNoise) {
  TrainingImage image;
  image.images = {Grid<float>(2, 2, 2.0f)};
  ResidualSum sum({"signal"});
  sum.add({Grid<double>(2, 2, 2.5)}, image);
  EXPECT_DOUBLE_EQ(sum.residuals()[0].rms, 0.5);
  EXPECT_DOUBLE_EQ(sum.residuals()[0].mean_relative, 0.25);
}

TEST(ModelResidual, CountsUsedPixelsOnlyAndNoZeroInTheRelativeMean) {
  TrainingImage image;
  image.images = {Grid<float>(2, 2, 2.0f)};
  image.images[0](0, 0) = 0;
  image.images[0](1, 1) = NAN;
  image.used = Grid<unsigned char>(2, 2, 1);
  image.used(1, 1) = 0;
  ResidualSum sum({"SE"});
  sum.add({Grid<double>(2, 2, 3.0)}, image);
  const ModelResidual r = sum.residuals()[0];
  EXPECT_EQ(r.pixels, 3);
  EXPECT_DOUBLE_EQ(r.mean_relative, 0.5);
  EXPECT_DOUBLE_EQ(r.rms, std::sqrt((9.0 + 1 + 1) / 3));
}

TEST(ModelResidual, OfNoiseAloneIsZeroAndNeverNan) {
  ResidualSum sum({"SE"}), empty({"SE"});
  TrainingImage image = noisy(0.3, 3);
  image.standard_errors[0] = Grid<float>(side, side, 0.5f);
  sum.add({Grid<double>(side, side, 2.0)}, image);
  EXPECT_EQ(sum.residuals()[0].rms, 0);
  EXPECT_EQ(empty.residuals()[0].rms, 0);
  EXPECT_EQ(empty.residuals()[0].mean_relative, 0);
}

TEST(ModelResidual, RefusesOtherSizes) {
  TrainingImage image;
  image.images = {Grid<float>(2, 2, 2.0f)};
  ResidualSum sum({"SE"}), two({"SE", "BSE"});
  EXPECT_THROW(sum.add({Grid<double>(3, 2)}, image), InvalidInput);
  EXPECT_THROW(two.add({Grid<double>(2, 2), Grid<double>(2, 2)}, image), InvalidInput);
}

}  // namespace
}  // namespace surf
