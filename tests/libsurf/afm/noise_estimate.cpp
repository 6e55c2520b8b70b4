// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise_estimate.h"

#include <cmath>

#include "statistics.h"
#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

HeightField noisy(const AfmNoise& noise, int width, int height, std::uint64_t seed) {
  HeightField f;
  f.z_nm = simulate_noise(noise, width, height, seed);
  return f;
}

void add_bow(HeightField& f) {
  for (int y = 0; y < f.z_nm.height(); ++y)
    for (int x = 0; x < f.z_nm.width(); ++x)
      f.z_nm(x, y) += 300 + 0.1 * x - 0.2 * y + 1e-3 * x * x + 2e-3 * x * y;
}

/// z-test over draws: the mean of many estimates, and the scatter against the stated standard
/// errors.
template <class Estimate>
void expect_recovered(const AfmNoise& noise, const Estimate& estimate, double bias_allowed) {
  constexpr int draws = 60;
  test::Sample alpha, innovation, sigma, alpha_variance, innovation_variance, sigma_variance;
  for (int i = 0; i < draws; ++i) {
    const NoiseEstimate e = estimate(static_cast<std::uint64_t>(i + 1));
    alpha.add(e.noise.alpha);
    innovation.add(e.noise.innovation_nm2);
    sigma.add(e.sigma_nm());
    alpha_variance.add(e.alpha_stderr * e.alpha_stderr);
    innovation_variance.add(e.innovation_stderr_nm2 * e.innovation_stderr_nm2);
    sigma_variance.add(e.sigma_stderr_nm * e.sigma_stderr_nm);
  }
  const double true_sigma = std::sqrt(noise.variance_nm2());
  test::expect_mean(alpha.mean(), alpha.standard_error(), noise.alpha, 36, bias_allowed);
  test::expect_mean(innovation.mean(), innovation.standard_error(), noise.innovation_nm2, 36,
                    bias_allowed * noise.innovation_nm2);
  test::expect_mean(sigma.mean(), sigma.standard_error(), true_sigma, 36,
                    bias_allowed * true_sigma);
  const auto compare = [](const test::Sample& scatter, const test::Sample& stated) {
    const double ratio = draws * std::pow(scatter.standard_error(), 2) / stated.mean();
    EXPECT_GT(ratio, 0.4) << "standard errors are too large";
    EXPECT_LT(ratio, 2.2) << "standard errors are too small";
  };
  compare(alpha, alpha_variance);
  compare(innovation, innovation_variance);
  compare(sigma, sigma_variance);
}

TEST(EstimateFlatNoise, RecoversTheModelUnderABow) {
  for (const AfmNoise noise : {AfmNoise{0.825, 0.201}, AfmNoise{0, 0.01}, AfmNoise{-0.4, 3}})
    expect_recovered(
        noise,
        [&](std::uint64_t seed) {
          HeightField f = noisy(noise, 96, 80, seed);
          add_bow(f);
          return estimate_flat_noise(f);
        },
        1e-3);
}

TEST(EstimateFlatNoise, MakesUpForWhatThePolynomialTakesOfSmallScans) {
  const AfmNoise noise{0.8, 0.2};
  expect_recovered(
      noise, [&](std::uint64_t seed) { return estimate_flat_noise(noisy(noise, 64, 16, seed)); },
      0.01);
}

TEST(EstimateFlatNoise, LeavesOutHolesAndWhatIsMasked) {
  const AfmNoise noise{0.6, 1};
  expect_recovered(
      noise,
      [&](std::uint64_t seed) {
        HeightField f = noisy(noise, 96, 80, seed);
        f.valid = Mask(96, 80, 1);
        Mask use(96, 80, 1);
        for (int y = 0; y < 80; ++y) {
          f.z_nm(7, y) = NAN;
          f.valid(7, y) = 0;
          for (int x = 40; x < 60; ++x) f.z_nm(x, y) += 50, use(x, y) = 0;
        }
        return estimate_flat_noise(f, {}, use);
      },
      2e-3);
}

TEST(EstimateFlatNoise, OfNothingIsNothing) {
  EXPECT_EQ(estimate_flat_noise(noisy({0, 0}, 20, 20, 1)).noise.innovation_nm2, 0);
}

TEST(EstimateFlatNoise, RefusesTooLittle) {
  EXPECT_THROW(estimate_flat_noise(noisy({0, 1}, 4, 5, 1)), InvalidInput);
  EXPECT_THROW(estimate_flat_noise(noisy({0, 1}, 40, 50, 1), {.degree = 7}), UsageError);
  HeightField holes = noisy({0, 1}, 40, 50, 1);
  holes.valid = Mask(40, 50, 0);
  EXPECT_THROW(estimate_flat_noise(holes), InvalidInput);
}

TEST(EstimateNoise, RecoversTheModelOfAFlatScan) {
  for (const AfmNoise noise : {AfmNoise{0.7, 0.2}, AfmNoise{0, 0.01}, AfmNoise{-0.4, 3}})
    expect_recovered(
        noise, [&](std::uint64_t seed) { return estimate_noise(noisy(noise, 160, 160, seed)); },
        0.02);
}

TEST(EstimateNoise, SeesPastTiltRowOffsetsAndLines) {
  const AfmNoise noise{0.5, 0.04};
  expect_recovered(
      noise,
      [&](std::uint64_t seed) {
        HeightField f = noisy(noise, 160, 160, seed);
        for (int y = 0; y < 160; ++y)
          for (int x = 0; x < 160; ++x)
            f.z_nm(x, y) += 3 * x - y + (y * 7 % 13) + (x / 20 % 2 ? 100 : 0);
        return estimate_noise(f);
      },
      0.03);
}

TEST(EstimateNoise, IsLittleTooLargeOnSmoothStructure) {
  const AfmNoise noise{0.4, 0.04};
  HeightField f = make_rough({160, 160, 1}, 5, 20, 3);
  const Grid<double> e = simulate_noise(noise, f.z_nm.width(), f.z_nm.height(), 5);
  for (std::size_t i = 0; i < e.size(); ++i) f.z_nm.data()[i] += e.data()[i];
  const NoiseEstimate found = estimate_noise(f);
  EXPECT_NEAR(found.sigma_nm(), std::sqrt(noise.variance_nm2()), 0.1 * found.sigma_nm());
}

TEST(EstimateNoise, OfNoiselessHeightsIsNothing) {
  HeightField f = noisy({0, 0}, 20, 20, 1);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) f.z_nm(x, y) = 2 * x + y;
  EXPECT_EQ(estimate_noise(f).noise.innovation_nm2, 0);
}

TEST(EstimateNoise, WorksFromFiveByThreeOnAndRefusesLess) {
  EXPECT_GT(estimate_noise(noisy({0, 1}, 5, 3, 1)).sigma_nm(), 0);
  EXPECT_THROW(estimate_noise(noisy({0, 1}, 4, 3, 1)), InvalidInput);
  EXPECT_THROW(estimate_noise(noisy({0, 1}, 50, 2, 1)), InvalidInput);
}

/// Ground that bends everywhere, as a dull tip draws it, is no noise.
TEST(EstimateNoise, IsRightOnRoughGround) {
  const AfmNoise noise{0.8, 0.2};
  for (const std::uint64_t seed : {1, 2, 3}) {
    HeightField f = noisy(noise, 160, 120, seed);
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x)
        f.z_nm(x, y) += 30 * std::sin(0.45 * x + 0.2 * y) * std::cos(0.37 * y - 0.1 * x) +
                        12 * std::sin(0.31 * x * std::cos(0.02 * y));
    const NoiseEstimate e = estimate_noise(f);
    EXPECT_NEAR(e.sigma_nm(), std::sqrt(noise.variance_nm2()), 0.15) << seed;
    EXPECT_FALSE(e.alpha_at_limit);
    EXPECT_LT(e.sigma_stderr_nm, 0.1);
  }
}

}  // namespace
}  // namespace surf
