// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise_check.h"

#include <cmath>

#include "statistics.h"
#include "surf/afm/noise.h"
#include "surf/core/error.h"

namespace surf {
namespace {

TEST(ChiSquaredTail, HasTabulatedValues) {
  EXPECT_NEAR(chi_squared_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(5.991464547107979, 2), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(21.665994333461924, 9), 0.01, 1e-12);
  EXPECT_EQ(chi_squared_tail(0, 3), 1);
}

TEST(CheckNoise, GivesPValuesThatAreUniformForTheRightModel) {
  const AfmNoise noise{0.6, 0.3};
  constexpr int draws = 500;
  std::vector<std::int64_t> along(10), across(10), normal(10);
  const auto count = [](std::vector<std::int64_t>& bins, double p) {
    ++bins[static_cast<std::size_t>(std::min(9.0, 10 * p))];
  };
  for (int i = 0; i < draws; ++i) {
    const Grid<double> e = simulate_noise(noise, 64, 64, static_cast<std::uint64_t>(i));
    const NoiseCheck c = check_noise(whiten(e, noise), {}, {.fitted_parameters = 0});
    count(along, c.along_p);
    count(across, c.across_p);
    count(normal, c.normal_p);
  }
  const std::vector<double> expected(10, draws / 10.0);
  test::expect_distributed(along, expected, 3);
  test::expect_distributed(across, expected, 3);
  test::expect_distributed(normal, expected, 3);
}

TEST(CheckNoise, SeesWhatIsNotWhite) {
  const Grid<double> e = simulate_noise({0.3, 1}, 64, 64, 1);
  const NoiseCheck wrong = check_noise(e);
  EXPECT_LT(wrong.along_p, 1e-10);
  EXPECT_GT(wrong.across_p, 1e-4);
  EXPECT_NEAR(wrong.along[0].correlation, 0.3, 0.07);
  Grid<double> turned(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) turned(y, x) = e(x, y);
  EXPECT_LT(check_noise(turned).across_p, 1e-10);
  EXPECT_GT(check_noise(turned).along_p, 1e-4);
}

TEST(CheckNoise, SeesWhatIsNotNormal) {
  Grid<double> e = simulate_noise({0, 1}, 64, 64, 1);
  for (double& v : e.data()) v = std::fabs(v) * v;
  const NoiseCheck c = check_noise(e);
  EXPECT_LT(c.normal_p, 1e-10);
  EXPECT_GT(c.excess_kurtosis, 1);
  EXPECT_GT(c.along_p, 1e-4);
}

TEST(CheckNoise, DividesSkewnessAndKurtosisByTheirExactVariances) {
  Grid<double> e(20, 1);
  for (int x = 0; x < 20; ++x) e(x, 0) = x * x;
  const NoiseCheck c = check_noise(e);
  const double n = 20, of_skewness = 6 * 18 / (21.0 * 23),
               of_kurtosis = 24 * n * 18 * 17 / (21.0 * 21 * 23 * 25);
  EXPECT_NEAR(c.jarque_bera,
              c.skewness * c.skewness / of_skewness +
                  std::pow(c.excess_kurtosis + 6 / 21.0, 2) / of_kurtosis,
              1e-12);
  EXPECT_NEAR(c.normal_p, std::exp(-c.jarque_bera / 2), 1e-12);
}

TEST(CheckNoise, LeavesOutHoles) {
  Grid<double> e = simulate_noise({0, 1}, 64, 64, 1);
  Mask valid(64, 64, 1);
  for (int y = 0; y < 64; ++y) valid(9, y) = 0, e(9, y) = NAN;
  const NoiseCheck c = check_noise(e, valid);
  EXPECT_EQ(c.samples, 63u * 64);
  EXPECT_GT(c.along_p, 1e-4);
}

TEST(CheckNoise, RefusesTooLittleAndAllEqual) {
  EXPECT_THROW(check_noise(Grid<double>(3, 3, 1)), InvalidInput);
  EXPECT_THROW(check_noise(Grid<double>(9, 9, 1)), InvalidInput);
  EXPECT_THROW(check_noise(Grid<double>(9, 9, NAN)), InvalidInput);
  EXPECT_THROW(check_noise(Grid<double>(9, 9), Mask(2, 2)), InvalidInput);
}

TEST(Autocovariance, FollowsTheModel) {
  const AfmNoise noise{0.8, 0.36};
  const std::vector<double> r = autocovariance(simulate_noise(noise, 256, 256, 1), 3);
  for (std::size_t k = 0; k < r.size(); ++k)
    EXPECT_NEAR(r[k], std::pow(0.8, static_cast<double>(k)), 0.05);
}

}  // namespace
}  // namespace surf
