// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "sem/noisy_images.h"
#include "statistics.h"
#include "surf/core/error.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const SemNoise true_noise{0.6, 5, 1e-3};

TEST(FitSemNoise, RecoversTheLineWithItsErrors) {
  const Grid<double> mean = test::plateaus(120, 90);
  constexpr int images = 200;
  test::Sample slope, intercept;
  int covered = 0;
  std::vector<std::int64_t> counts(5);
  for (int i = 0; i < images; ++i) {
    const SemNoiseEstimate e = fit_sem_noise(test::draw(mean, true_noise, 300 + i), mean);
    slope.add((e.noise.slope - true_noise.slope) / e.slope_stderr());
    intercept.add((e.noise.intercept - true_noise.intercept) / e.intercept_stderr());
    covered += std::fabs(e.noise.slope - true_noise.slope) <= 1.96 * e.slope_stderr();
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(5 * e.p), 4)];
  }
  test::expect_mean(slope.mean(), slope.standard_error(), 0, 3);
  test::expect_mean(intercept.mean(), intercept.standard_error(), 0, 3);
  EXPECT_GE(covered, 178);
  test::expect_distributed(counts, std::vector<double>(5, images / 5.0), 3);
}

TEST(FitSemNoise, IsWhereTheLikelihoodIsLargest) {
  const Grid<double> mean = test::plateaus(120, 90);
  const Grid<double> real = test::draw(mean, true_noise, 1);
  const SemNoise best = fit_sem_noise(real, mean).noise;
  const double largest = log_likelihood(real, mean, best);
  for (const double ds : {-0.01, 0.0, 0.01})
    for (const double di : {-0.5, 0.0, 0.5}) {
      SemNoise other = best;
      other.slope += ds, other.intercept += di;
      EXPECT_LE(log_likelihood(real, mean, other), largest + 1e-9) << ds << ' ' << di;
    }
}

TEST(FitSemNoise, OnlyUsedPixelsCount) {
  const Grid<double> mean = test::plateaus(120, 90);
  Grid<double> real = test::draw(mean, true_noise, 1);
  Mask used(120, 90, 1);
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 40; ++x)
      used(x, y) = 0, real(x, y) = std::numeric_limits<double>::quiet_NaN();
  const SemNoiseEstimate e = fit_sem_noise(real, mean, used);
  EXPECT_EQ(e.pixels, 80 * 90);
  EXPECT_NEAR(e.noise.variance(90), true_noise.variance(90), 0.1 * true_noise.variance(90));
  EXPECT_THROW(fit_sem_noise(real, mean), InvalidInput);
}

TEST(FitSemNoise, LineBelowZeroBends) {
  const SemNoise noise{1, -60, 0.4};
  const Grid<double> mean = test::plateaus(240, 180);
  const SemNoiseEstimate e = fit_sem_noise(test::draw(mean, noise, 1), mean);
  EXPECT_TRUE(std::isfinite(e.noise.slope) && std::isfinite(e.noise.intercept));
  EXPECT_NEAR(e.noise.variance(130), 70, 4);
  EXPECT_GT(e.off_line_share, 0.05);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("least variance")));
}

TEST(FitSemNoise, WhatTheModelIsOffByIsSeen) {
  const Grid<double> mean = test::plateaus(240, 180);
  const Grid<double> real = test::draw(mean, true_noise, 1);
  Grid<double> smooth = mean;  // a model that knows no edges
  for (int y = 2; y < 178; ++y)
    for (int x = 2; x < 238; ++x) {
      double sum = 0;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) sum += mean(x + i, y + j);
      smooth(x, y) = sum / 25;
    }
  const SemNoiseEstimate e = fit_sem_noise(real, smooth);
  EXPECT_GT(e.correlation_x, 0.05);
  EXPECT_GT(e.excess_kurtosis, 0.1);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("correlated")));
}

TEST(FitSemNoise, RefusesWhatHasNoNoise) {
  const Grid<double> mean = test::plateaus(40, 30);
  EXPECT_THROW(fit_sem_noise(mean, mean), InvalidInput);
  EXPECT_THROW(fit_sem_noise(mean, Grid<double>(3, 3)), InvalidInput);
  EXPECT_THROW(fit_sem_noise(Grid<double>(3, 3, 1), Grid<double>(3, 3)), InvalidInput);
  const SemNoiseEstimate e =
      fit_sem_noise(test::draw(Grid<double>(40, 30, 50), true_noise, 1), Grid<double>(40, 30, 50));
  EXPECT_FALSE(e.slope_known);
  EXPECT_NEAR(e.noise.variance(50), 35, 7);
  EXPECT_TRUE(std::isfinite(e.slope_stderr()));
}

}  // namespace
}  // namespace surf
