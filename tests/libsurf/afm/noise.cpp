// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "statistics.h"
#include "surf/core/error.h"

namespace surf {
namespace {

/// Holes of one, two and many columns, at the start and the end of rows, and a row of holes.
Mask some_holes(int width, int height) {
  Mask valid(width, height, 1);
  valid(3, 0) = 0;
  valid(0, 1) = valid(1, 1) = valid(width - 1, 1) = 0;
  for (int x = 0; x < width; ++x) valid(x, 2) = 0;
  for (int x = 2; x < width - 1; ++x) valid(x, 3) = 0;
  return valid;
}

/// The density of a row by its whole covariance matrix, s^2 alpha^|i - j|, by Gaussian elimination.
double dense_log_likelihood(const Grid<double>& e, const AfmNoise& noise, const Mask& valid) {
  double total = 0;
  for (int y = 0; y < e.height(); ++y) {
    std::vector<int> at;
    for (int x = 0; x < e.width(); ++x)
      if (valid(x, y)) at.push_back(x);
    const std::size_t n = at.size();
    std::vector<std::vector<double>> a(n, std::vector<double>(n + 1));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        a[i][j] = noise.variance_nm2() * std::pow(noise.alpha, std::abs(at[i] - at[j]));
      a[i][n] = e(at[i], y);
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = k + 1; i < n; ++i) {
        const double f = a[i][k] / a[k][k];
        for (std::size_t j = k; j <= n; ++j) a[i][j] -= f * a[k][j];
      }
      total -= 0.5 * (std::log(2 * std::numbers::pi * a[k][k]) + a[k][n] * a[k][n] / a[k][k]);
    }
  }
  return total;
}

TEST(AfmNoise, HasTheVarianceAndCorrelationOfItsModelFromTheFirstColumnOn) {
  const AfmNoise noise{0.825, 0.201};
  constexpr int rows = 40000, width = 6;
  const Grid<double> e = simulate_noise(noise, width, rows, 7);
  for (const int x : {0, 1, width - 1}) {
    test::Sample square, pair;
    for (int y = 0; y < rows; ++y) {
      square.add(e(x, y) * e(x, y));
      pair.add(e(x, y) * e(0, y));
    }
    test::expect_mean(square.mean(), square.standard_error(), noise.variance_nm2(), 6);
    test::expect_mean(pair.mean(), pair.standard_error(),
                      noise.variance_nm2() * std::pow(noise.alpha, x), 6);
  }
}

TEST(AfmNoise, KeepsRowsWhenTheImageGrows) {
  const Grid<double> small = simulate_noise({0.5, 1}, 5, 4, 3),
                     large = simulate_noise({0.5, 1}, 9, 6, 3);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(small(x, y), large(x, y));
  EXPECT_NE(small, simulate_noise({0.5, 1}, 5, 4, 4));
}

TEST(AfmNoise, WithoutInnovationIsZero) {
  EXPECT_EQ(simulate_noise({0.5, 0}, 3, 2, 1), Grid<double>(3, 2));
}

TEST(Whiten, MakesIndependentStandardNormalNumbersOfTheNoiseWithHolesToo) {
  const AfmNoise noise{0.7, 0.04};
  constexpr int rows = 20000, width = 8;
  Mask valid(width, rows, 1);
  for (int y = 0; y < rows; ++y) valid(3, y) = valid(4, y) = 0;
  const Grid<double> w = whiten(simulate_noise(noise, width, rows, 5), noise, valid);
  for (const int x : {0, 1, 2, 5, 6}) {
    test::Sample square, pair;
    const int next = x == 2 ? 5 : x + 1;
    for (int y = 0; y < rows; ++y) {
      square.add(w(x, y) * w(x, y));
      pair.add(w(x, y) * w(next, y));
    }
    test::expect_mean(square.mean(), square.standard_error(), 1, 10);
    test::expect_mean(pair.mean(), pair.standard_error(), 0, 10);
  }
  EXPECT_EQ(w(3, 17), 0);
}

TEST(LogLikelihood, IsThatOfTheWholeCovarianceMatrix) {
  const Mask valid = some_holes(9, 5);
  for (const double alpha : {-0.6, 0.0, 0.3, 0.95}) {
    const AfmNoise noise{alpha, 0.3};
    const Grid<double> e = simulate_noise({0.4, 2}, 9, 5, 11);
    EXPECT_NEAR(log_likelihood(e, noise, valid), dense_log_likelihood(e, noise, valid), 1e-9);
    const Mask whole(9, 5, 1);
    EXPECT_NEAR(log_likelihood(e, noise), dense_log_likelihood(e, noise, whole), 1e-9);
  }
}

TEST(LogLikelihood, HasTheGradientOfFiniteDifferences) {
  const Mask valid = some_holes(9, 5);
  const AfmNoise noise{0.825, 0.201};
  Grid<double> e = simulate_noise(noise, 9, 5, 2), gradient;
  log_likelihood(e, noise, valid, &gradient);
  for (std::size_t i = 0; i < e.size(); ++i) {
    const double at = e.data()[i], step = 1e-4;
    e.data()[i] = at + step;
    const double up = log_likelihood(e, noise, valid);
    e.data()[i] = at - step;
    const double down = log_likelihood(e, noise, valid);
    e.data()[i] = at;
    EXPECT_NEAR(gradient.data()[i], (up - down) / (2 * step), 1e-7) << i;
  }
}

TEST(LogLikelihood, IgnoresWhatIsInHoles) {
  const Mask valid = some_holes(9, 5);
  Grid<double> e = simulate_noise({0.5, 1}, 9, 5, 2);
  const double before = log_likelihood(e, {0.5, 1}, valid);
  e(3, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(log_likelihood(e, {0.5, 1}, valid), before);
}

TEST(AfmNoise, RefusesImpossibleModelsAndSizes) {
  EXPECT_THROW(simulate_noise({1, 1}, 2, 2, 1), InvalidInput);
  EXPECT_THROW(simulate_noise({NAN, 1}, 2, 2, 1), InvalidInput);
  EXPECT_THROW(simulate_noise({0, -1}, 2, 2, 1), InvalidInput);
  EXPECT_THROW(simulate_noise({0, 1}, 0, 2, 1), UsageError);
  EXPECT_THROW(log_likelihood(Grid<double>(2, 2), {0, 0}), InvalidInput);
  EXPECT_THROW(whiten(Grid<double>(2, 2, NAN), {0, 1}), InvalidInput);
  EXPECT_THROW(whiten(Grid<double>(2, 2), {0, 1}, Mask(2, 3)), InvalidInput);
}

}  // namespace
}  // namespace surf
