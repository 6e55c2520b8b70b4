// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/sem_noise.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "sem/noisy_images.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Grid<double> ramp(int width, int height, double from, double to) {
  Grid<double> g(width, height);
  for (std::size_t i = 0; i < g.size(); ++i)
    g.data()[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(g.size() - 1);
  return g;
}

TEST(SemNoise, FollowsTheLineAboveTheLeastVariance) {
  const SemNoise noise{0.5, -3, 0.1};
  EXPECT_DOUBLE_EQ(noise.variance(10), 2);
  EXPECT_DOUBLE_EQ(noise.variance_slope(10), 0.5);
  const SemNoise falling{-0.5, 10, 0.1};
  EXPECT_DOUBLE_EQ(falling.variance(10), 5);
  EXPECT_DOUBLE_EQ(falling.variance_slope(10), -0.5);
}

TEST(SemNoise, StaysAtTheLeastVarianceWhereTheLineIsNegative) {
  const SemNoise noise{0.5, -3, 0.1};
  for (const double mean : {6.0, 0.0, -1e6}) {
    EXPECT_EQ(noise.variance(mean), 0.1) << mean;
    EXPECT_EQ(noise.variance_slope(mean), 0) << mean;
  }
}

TEST(SemNoise, BendsWithoutAStep) {
  for (const double slope : {0.5, -0.5}) {
    const SemNoise noise{slope, -3 * std::copysign(1, slope) + (slope < 0 ? 6 : 0), 0.1};
    double before = noise.variance(-20);
    for (double mean = -20; mean < 20; mean += 1e-3) {
      const double v = noise.variance(mean), h = 1e-6;
      EXPECT_GE(v, 0.1);
      EXPECT_LE(std::fabs(v - before), 1.01e-3 * std::fabs(slope));
      EXPECT_NEAR((noise.variance(mean + h) - noise.variance(mean - h)) / (2 * h),
                  noise.variance_slope(mean), 1e-5);
      EXPECT_LE(std::fabs(noise.variance_slope(mean + 1e-3) - noise.variance_slope(mean)),
                1.01e-3 * slope * slope / 0.2);
      before = v;
    }
    // Both ends of the bend: where the line is 0 and where it is twice the least variance.
    for (const double line : {0.0, 0.2}) {
      const double mean = (line - noise.intercept) / slope;
      EXPECT_NEAR(noise.variance(mean - 1e-9), noise.variance(mean + 1e-9), 1e-8);
      EXPECT_NEAR(noise.variance_slope(mean - 1e-9), noise.variance_slope(mean + 1e-9), 1e-7);
    }
  }
}

TEST(SemNoise, LikelihoodIsTheNormalDensity) {
  const Grid<double> mean = ramp(4, 3, -4, 20);
  const SemNoise noise{0.5, -1, 0.3};
  const Grid<double> real = test::draw(mean, noise, 3);
  double density = 1;
  for (std::size_t i = 0; i < real.size(); ++i) {
    const double v = noise.variance(mean.data()[i]), e = real.data()[i] - mean.data()[i];
    density *= std::exp(-e * e / (2 * v)) / std::sqrt(2 * std::numbers::pi * v);
  }
  EXPECT_NEAR(log_likelihood(real, mean, noise), std::log(density), 1e-10);
}

TEST(SemNoise, PixelsThatAreNotUsedMayBeAnything) {
  const Grid<double> mean = ramp(4, 3, 5, 20);
  const SemNoise noise{0.5, 1, 0.3};
  Grid<double> real = test::draw(mean, noise, 3);
  Mask used(4, 3, 1);
  used(1, 1) = 0;
  const double all = log_likelihood(real, mean, noise);
  const double e = real(1, 1) - mean(1, 1), v = noise.variance(mean(1, 1));
  real(1, 1) = nan;
  Grid<double> gradient, information;
  EXPECT_NEAR(log_likelihood(real, mean, noise, used, &gradient, &information),
              all + 0.5 * (std::log(2 * std::numbers::pi * v) + e * e / v), 1e-10);
  EXPECT_EQ(gradient(1, 1), 0);
  EXPECT_EQ(information(1, 1), 0);
  EXPECT_EQ(whiten(real, mean, noise, used)(1, 1), 0);
  EXPECT_THROW(log_likelihood(real, mean, noise), InvalidInput);
}

TEST(SemNoise, GradientIsThatOfTheLikelihood) {
  // On the line, on the bend and on the floor.
  Grid<double> mean = ramp(8, 3, -3, 6);
  const SemNoise noise{0.5, -0.2, 0.4};
  const Grid<double> real = test::draw(mean, noise, 5);
  Grid<double> gradient;
  log_likelihood(real, mean, noise, {}, &gradient);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    Grid<double> up = mean, down = mean;
    up.data()[i] += 1e-5, down.data()[i] -= 1e-5;
    const double difference =
        (log_likelihood(real, up, noise) - log_likelihood(real, down, noise)) / 2e-5;
    EXPECT_NEAR(gradient.data()[i], difference, 1e-5 * std::fmax(1, std::fabs(difference))) << i;
  }
}

TEST(SemNoise, InformationIsTheScatterOfTheGradient) {
  constexpr int draws = 40000;
  for (const double intensity : {-1.0, 0.9, 10.0}) {  // floor, bend, line
    const SemNoise noise{0.5, -0.2, 0.4};
    const Grid<double> mean(200, draws / 200, intensity);
    Grid<double> gradient, information;
    log_likelihood(test::draw(mean, noise, 11), mean, noise, {}, &gradient, &information);
    test::Sample first, second;
    for (const double g : gradient.data()) first.add(g), second.add(g * g);
    test::expect_mean(first.mean(), first.standard_error(), 0, 6);
    test::expect_mean(second.mean(), second.standard_error(), information(0, 0), 6);
  }
}

TEST(SemNoise, WhitenedPixelsAreStandardNormal) {
  const Grid<double> mean = ramp(100, 100, -10, 200);
  const SemNoise noise{0.5, -0.2, 0.4};
  const Grid<double> white = whiten(test::draw(mean, noise, 21), mean, noise);
  test::Sample first, second;
  for (const double w : white.data()) first.add(w), second.add(w * w);
  test::expect_mean(first.mean(), first.standard_error(), 0, 2);
  test::expect_mean(second.mean(), second.standard_error(), 1, 2);
}

TEST(SemNoise, RefusesWhatItCannotUse) {
  EXPECT_THROW(validate(SemNoise{nan, 1, 1}), InvalidInput);
  EXPECT_THROW(validate(SemNoise{1, nan, 1}), InvalidInput);
  EXPECT_THROW(validate(SemNoise{1, 1, 0}), InvalidInput);
  EXPECT_THROW(validate(SemNoise{1, 1, nan}), InvalidInput);
  EXPECT_THROW(log_likelihood(Grid<double>(2, 2), Grid<double>(2, 3), {}), InvalidInput);
  EXPECT_THROW(log_likelihood(Grid<double>(2, 2), Grid<double>(2, 2), {}, Mask(1, 1)),
               InvalidInput);
  EXPECT_THROW(whiten(Grid<double>(2, 2), Grid<double>(3, 2), {}), InvalidInput);
  EXPECT_THROW(log_likelihood({}, {}, {}), InvalidInput);
}

}  // namespace
}  // namespace surf
