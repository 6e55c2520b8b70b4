// SPDX-License-Identifier: GPL-3.0-or-later
// make_rough of surf/mesh/shapes.h: its statistics.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

/// Normalized autocorrelation at a lag along x and along y, periodically.
double autocorrelation(const Grid<double>& z, int lag_x, int lag_y) {
  double product = 0;
  double square = 0;
  for (int y = 0; y < z.height(); ++y) {
    for (int x = 0; x < z.width(); ++x) {
      product += z(x, y) * z((x + lag_x) % z.width(), (y + lag_y) % z.height());
      square += z(x, y) * z(x, y);
    }
  }
  return product / square;
}

double moment(const Grid<double>& z, int power) {
  double sum = 0;
  for (const double v : z.data()) sum += std::pow(v, power);
  return sum / static_cast<double>(z.size());
}

}  // namespace

TEST(MakeRough, HasZeroMeanAndExactlyTheRmsAskedFor) {
  for (const double rms : {0.1, 3.0, 250.0}) {
    for (const double correlation : {0.5, 4.0, 60.0}) {
      const HeightField field = make_rough({200, 150, 1}, rms, correlation, 11);
      EXPECT_NEAR(moment(field.z_nm, 1), 0, 1e-12 * rms);
      EXPECT_NEAR(std::sqrt(moment(field.z_nm, 2)), rms, 1e-12 * rms);
    }
  }
}

TEST(MakeRough, HasTheGaussianAutocorrelationAskedFor) {
  // Pitch 2 and L = 8: L is 4 samples. A lag's estimate scatters with the square root of
  // 2 sum(rho^2) / N = pi L^2 / N, at most; 5 of these leave the test a family-wise error far below
  // 1e-4. A kernel of the wrong width is 30 of them off.
  constexpr int n = 800;
  const HeightField field = make_rough({2.0 * (n - 1), 2.0 * (n - 1), 2}, 5, 8, 7);
  ASSERT_EQ(field.z_nm.width(), n);
  const double tolerance = 5 * std::sqrt(std::numbers::pi * 16) / n;
  constexpr std::pair<int, int> lags[] = {{1, 0}, {0, 1}, {2, 0}, {4, 0},
                                          {0, 4}, {3, 3}, {8, 0}, {0, 8}};
  for (const auto& [x, y] : lags) {
    EXPECT_NEAR(autocorrelation(field.z_nm, x, y), std::exp(-(x * x + y * y) / 16.0), tolerance)
        << x << ' ' << y;
  }
}

TEST(MakeRough, HasGaussianHeights) {
  // Independent patches: N / (pi L^2 / 2); skewness and kurtosis scatter with 6 and 24 over that.
  const HeightField field = make_rough({799, 799, 1}, 1, 2, 3);
  const double patches = 640000 / (std::numbers::pi * 4 / 2);
  EXPECT_NEAR(moment(field.z_nm, 3), 0, 5 * std::sqrt(6 / patches));
  EXPECT_NEAR(moment(field.z_nm, 4), 3, 5 * std::sqrt(24 / patches));
}

TEST(MakeRough, IsSmoothAcrossItsPeriodicEdge) {
  // Steps over the seam follow the same law as steps inside; a jump would be L times larger.
  const HeightField field = make_rough({499, 299, 1}, 1, 10, 5);
  const Grid<double>& z = field.z_nm;
  const double step_variance = 2 * (1 - std::exp(-1.0 / 100));
  double across_x = 0;
  for (int y = 0; y < z.height(); ++y) across_x += std::pow(z(0, y) - z(z.width() - 1, y), 2);
  double across_y = 0;
  for (int x = 0; x < z.width(); ++x) across_y += std::pow(z(x, 0) - z(x, z.height() - 1), 2);
  EXPECT_LT(across_x / z.height(), 3 * step_variance);
  EXPECT_LT(across_y / z.width(), 3 * step_variance);
}

TEST(MakeRough, TheSeedDecidesEverything) {
  const FieldExtent extent{60, 40, 1};
  const std::vector<double> z = make_rough(extent, 2, 3, 3).z_nm.data();
  EXPECT_EQ(z, make_rough(extent, 2, 3, 3).z_nm.data());
  // Other seeds are unrelated, also when one field is shifted against the other.
  const double scatter = std::sqrt(std::numbers::pi * 9 / 2 / static_cast<double>(z.size()));
  for (const std::uint64_t seed : {0, 1, 2, 4}) {
    const std::vector<double> other = make_rough(extent, 2, 3, seed).z_nm.data();
    for (std::size_t shift = 0; shift < 5; ++shift) {
      double product = 0;
      for (std::size_t i = 0; i < z.size(); ++i) product += z[i] * other[(i + shift) % z.size()];
      EXPECT_LT(std::abs(product / static_cast<double>(z.size()) / 4), 5 * scatter) << seed;
    }
  }
}

TEST(MakeRough, RefusesBadArguments) {
  const FieldExtent extent{60, 40, 1};
  EXPECT_THROW(make_rough(extent, 0, 3, 1), UsageError);
  EXPECT_THROW(make_rough(extent, 1, 0, 1), UsageError);
  EXPECT_THROW(make_rough(extent, 1, NAN, 1), UsageError);
  EXPECT_THROW(make_rough(extent, 1, 21, 1), UsageError) << "more than half of the 41 nm period";
  EXPECT_NO_THROW(make_rough(extent, 1, 20, 1));
}

}  // namespace surf
