// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/noise/variance_line.h"

#include <cmath>
#include <numbers>

#include "sem/noise/flat_samples.h"
#include "sem/noise/grey_levels.h"
#include "sem/noisy_images.h"
#include "statistics.h"

namespace surf {
namespace {

/// Chi-squared with 50 degrees about a line, or a parabola.
std::vector<VariancePoint> some_points(int count, std::uint64_t seed, double bend = 0) {
  std::vector<VariancePoint> points;
  RandomStream random(seed, 0, 0);
  for (int i = 0; i < count; ++i) {
    const double x = 10 + 90.0 * i / (count - 1);
    double chi = 0;
    for (int k = 0; k < 50; ++k) chi += std::pow(test::normal(random), 2) / 50;
    points.push_back({x, (3 + 0.5 * x + bend * (x - 55) * (x - 55)) * chi, 50});
  }
  return points;
}

TEST(VarianceLine, IsUnbiasedWithItsErrors) {
  test::Sample slope, intercept, scatter, curvature;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const VarianceLine l = fit_variance_line(some_points(60, i), {false, 1e-3, 3.5});
    slope.add((l.slope - 0.5) / std::sqrt(l.covariance[0]));
    intercept.add((l.intercept - 3) / std::sqrt(l.covariance[3]));
    scatter.add(std::pow((l.slope - 0.5) / std::sqrt(l.covariance[0]), 2));
    curvature.add(fit_curvature(some_points(60, i), l, 1e-3).z);
  }
  test::expect_mean(slope.mean(), slope.standard_error(), 0, 4);
  test::expect_mean(intercept.mean(), intercept.standard_error(), 0, 4);
  test::expect_mean(scatter.mean(), scatter.standard_error(), 1, 4);
  test::expect_mean(curvature.mean(), curvature.standard_error(), 0, 4, 0.05);
}

TEST(VarianceLine, LeavesOutWhatIsFarTooLarge) {
  std::vector<VariancePoint> points = some_points(60, 1);
  const VarianceLine clean = fit_variance_line(points, {false, 1e-3, 3.5});
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].variance *= 4;
  const VarianceLine robust = fit_variance_line(points, {false, 1e-3, 3.5});
  for (const double x : {10.0, 100.0}) {
    const double v = clean.slope * x + clean.intercept;
    EXPECT_NEAR(robust.slope * x + robust.intercept, v, 0.2 * v);
  }
  for (std::size_t i = 0; i < points.size(); i += 3) EXPECT_FALSE(robust.used[i]) << i;
}

TEST(VarianceLine, SeesABend) {
  const std::vector<VariancePoint> points = some_points(60, 2, 0.01);
  const VarianceLine line = fit_variance_line(points, {false, 1e-3, 0});
  const Curvature c = fit_curvature(points, line, 1e-3);
  EXPECT_GT(c.z, 5);
  // The parabola is 0.01 (x - 55)^2: seen from the best line, about a third of its height at the
  // ends.
  EXPECT_GT(c.departure, 0.1);
  EXPECT_LT(c.departure, 1);
  const std::vector<VariancePoint> straight = some_points(60, 2);
  EXPECT_LT(fit_curvature(straight, fit_variance_line(straight, {false, 1e-3, 0}), 1e-3).departure,
            0.15);
}

TEST(VarianceLine, OnePointOrOneMeanGivesAConstant) {
  const VarianceLine one = fit_variance_line({{5, 2, 10}}, {false, 1e-3, 3.5});
  EXPECT_EQ(one.slope, 0);
  EXPECT_DOUBLE_EQ(one.intercept, 2);
  EXPECT_NEAR(one.covariance[3], 2 * 4.0 / 10, 1e-12);
  const VarianceLine same = fit_variance_line({{5, 2, 10}, {5, 4, 10}}, {false, 1e-3, 0});
  EXPECT_EQ(same.slope, 0);
  EXPECT_NEAR(same.intercept, 3, 1e-9);
}

// Residuals of noise of known correlation: the response undoes what the polynomial took.
TEST(FlatSamples, CorrelationAndVarianceAreFreeOfThePolynomial) {
  test::Sample variance, along, two, across;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Grid<double> white(98, 96), image(96, 96);
    RandomStream random(seed, 5, 0);
    for (double& v : white.data()) v = test::normal(random);
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x)
        image(x, y) = (white(x, y) + white(x + 1, y) + white(x + 2, y)) / std::sqrt(3.0) + 0.1 * x -
                      0.002 * y * y;
    const Mask all;
    FlatSamples flat(image, all, 2);
    for (int y = 0; y + 12 <= 96; y += 12)
      for (int x = 0; x + 12 <= 96; x += 12) ASSERT_TRUE(flat.add({x, y, x + 12, y + 12}));
    EXPECT_EQ(flat.responses.size(), 1u);
    const LagSums r = pooled_correlation(flat, std::vector<double>(flat.samples.size(), 1));
    along.add(r[1]), two.add(r[2]), across.add(r[5]);
    for (const FlatSample& s : flat.samples)
      variance.add(variance_of(s, flat.responses[0], {1, 2.0 / 3, 1.0 / 3}));
  }
  test::expect_mean(variance.mean(), variance.standard_error(), 1, 4);
  test::expect_mean(along.mean(), along.standard_error(), 2.0 / 3, 4, 0.003);  // a ratio of sums
  test::expect_mean(two.mean(), two.standard_error(), 1.0 / 3, 4, 0.003);
  test::expect_mean(across.mean(), across.standard_error(), 0, 4, 0.003);
}

TEST(FlatSamples, WhiteNoiseLosesOneDegreeForEachCoefficient) {
  const Grid<double> image = test::draw(Grid<double>(12, 12, 5), {0, 1, 1e-3}, 1);
  const Mask all;
  for (const int degree : {0, 1, 2}) {
    FlatSamples flat(image, all, degree);
    ASSERT_TRUE(flat.add({0, 0, 12, 12}));
    EXPECT_NEAR(variance_of(flat.samples[0], flat.responses[0], {1}),
                flat.samples[0].squares / (144 - flat.coefficients()), 1e-12);
  }
}

TEST(GreyLevels, FindsStepsAndPiles) {
  const Grid<double> smooth = test::draw(Grid<double>(100, 100, 100), {0, 400, 1}, 1);
  EXPECT_EQ(grey_levels(smooth, {}).quantum, 0);
  const GreyLevels whole = grey_levels(test::rounded(smooth, 0, 255), {});
  EXPECT_EQ(whole.quantum, 1);
  EXPECT_FALSE(whole.black || whole.white);
  const GreyLevels cut = grey_levels(test::rounded(smooth, 80, 255), {});
  EXPECT_EQ(cut.black, 80);
  EXPECT_FALSE(cut.white);
  EXPECT_EQ(grey_levels(test::rounded(smooth, 0, 110), {}).white, 110);
  Grid<double> sixteen = test::rounded(smooth, 80, 110);
  for (double& v : sixteen.data()) v *= 257.0 / 65535;
  EXPECT_NEAR(grey_levels(sixteen, {}).quantum, 257.0 / 65535, 1e-12);
  Grid<double> sums =
      test::rounded(smooth, 0, 255);  // a palette's grey as a mixture of its three colours
  for (double& v : sums.data()) {
    const auto f = static_cast<float>(v);
    v = 0.2126f * f + 0.7152f * f + 0.0722f * f;
  }
  EXPECT_NEAR(grey_levels(sums, {}).quantum, 1, 1e-5);
  EXPECT_TRUE(grey_levels(sixteen, {}).black && grey_levels(sixteen, {}).white);
}

}  // namespace
}  // namespace surf
