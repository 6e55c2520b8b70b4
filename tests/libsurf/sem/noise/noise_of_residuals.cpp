// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/noise_of_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sem/noisy_images.h"
#include "surf/core/error.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf {
namespace {

const SemNoise true_noise{18, -9000,
                          1};  // as of 200 electrons per pixel: no variance at a level of 500

/// Levels from 850 to 2000, most of them near 1000.
Grid<double> levels() {
  Grid<double> mean(300, 150);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 300; ++x)
      mean(x, y) = 1000 + 60 * std::sin(0.05 * x) + (x % 60 < 8 ? 120.0 * (x % 60) : 0);
  return mean;
}

void expect_line(const SemNoise& noise, double share) {
  for (const double level : {900.0, 1000.0, 1300.0, 1800.0})
    EXPECT_NEAR(noise.variance(level) / true_noise.variance(level), 1, share) << level;
}

TEST(NoiseOfResiduals, IsTheLine) {
  for (const std::uint64_t seed : {1, 2, 3})
    expect_line(noise_of_residuals(test::draw(levels(), true_noise, seed), levels()), 0.1);
}

TEST(NoiseOfResiduals, WhatAModelIsOffByOnWallsIsNotNoise) {
  // The model is off by long waves, by the brightness of stripes, and every third of these is a
  // pixel beside its place.
  const Grid<double> mean = levels();
  Grid<double> model = mean;
  for (int y = 0; y < mean.height(); ++y)
    for (int x = 0; x < mean.width(); ++x) {
      const double bright = x % 60 < 8 ? 1 : 0;
      model(x, y) = mean(x < 299 && x / 60 % 3 == 1 ? x + 1 : x, y) +
                    0.2 * bright * (mean(x, y) - 1000) + 90 * std::sin(0.05 * (x + y));
    }
  const Grid<double> real = test::draw(mean, true_noise, 4);
  expect_line(noise_of_residuals(real, model), 0.3);
  EXPECT_GT(fit_sem_noise(real, model).noise.variance(1800), 1.5 * true_noise.variance(1800));
}

TEST(NoiseOfResiduals, IsConstantWhereNothingTellsTheSlope) {
  const Grid<double> mean(120, 90, 1000);
  const SemNoise noise = noise_of_residuals(test::draw(mean, true_noise, 5), mean);
  EXPECT_EQ(noise.slope, 0);
  EXPECT_NEAR(noise.variance(1000) / true_noise.variance(1000), 1, 0.1);
}

TEST(NoiseOfResiduals, OnlyUsedPixelsCount) {
  Grid<double> real = test::draw(levels(), true_noise, 1);
  Mask used(300, 150, 1);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 90; ++x)
      used(x, y) = 0, real(x, y) = std::numeric_limits<double>::quiet_NaN();
  expect_line(noise_of_residuals(real, levels(), used), 0.15);
  EXPECT_THROW(noise_of_residuals(real, levels()), InvalidInput);
}

TEST(NoiseOfResiduals, ImpossibleImagesAreRefused) {
  const Grid<double> mean = levels();
  EXPECT_THROW(noise_of_residuals(mean, mean), InvalidInput);
  EXPECT_THROW(noise_of_residuals(mean, Grid<double>(3, 3)), InvalidInput);
  EXPECT_THROW(noise_of_residuals(mean, mean, Mask(3, 3)), InvalidInput);
  EXPECT_THROW(noise_of_residuals(Grid<double>(8, 8, 1), Grid<double>(8, 8)), InvalidInput);
}

}  // namespace
}  // namespace surf
