// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/discrepancy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf::reconstruction {
namespace {

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) *
         std::cos(6.283185307179586 * random.uniform());
}

struct Case {
  std::vector<SemDiscrepancy> parts;
  Grid<double> row_jitter{34, 23};
  std::vector<Grid<double>> fields{{34, 23}, {34, 23}};
  Grid<double> weight{34, 23};

  Case() {
    RandomStream random(3, 0, 0);
    parts.push_back({Grid<double>(34, 23), 3});
    parts.push_back({Grid<double>(34, 23), 10});
    for (int y = 0; y < 23; ++y)
      for (int x = 0; x < 34; ++x) {
        parts[0].deviation(x, y) = 0.5 + 0.1 * x;
        parts[1].deviation(x, y) = 2;
        weight(x, y) = (x + y) % 9 == 0 ? 0 : 1 / (0.5 + random.uniform());
      }
    for (double& v : row_jitter.data()) v = 3 * normal(random);
    for (Grid<double>& field : fields)
      for (double& v : field.data()) v = 1 + 2 * normal(random);
  }
};

double dot(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.data()[i] * b.data()[i];
  return sum;
}

// For noise and discrepancy as described, r.Q r is chi-squared with as many degrees as pixels.
TEST(Discrepancy, PrecisionIsTheInverseOfTheCovariance) {
  const Case c;
  const Discrepancy discrepancy(c.parts, c.row_jitter, c.fields);
  const auto factor = discrepancy.factor(c.weight);
  double pixels = 0, sum = 0;
  for (const double w : c.weight.data()) pixels += w > 0;
  constexpr int draws = 200;
  for (int d = 0; d < draws; ++d) {
    RandomStream random(11, static_cast<std::uint64_t>(d), 0);
    Grid<double> r = factor->draw(5, static_cast<std::uint64_t>(d));
    for (std::size_t i = 0; i < r.size(); ++i)
      if (c.weight.data()[i] > 0) r.data()[i] += normal(random) / std::sqrt(c.weight.data()[i]);
    sum += dot(r, factor->precision(r));
  }
  const double z = (sum - draws * pixels) / std::sqrt(2 * draws * pixels);
  EXPECT_LT(std::abs(z), 4);
}

TEST(Discrepancy, TheLikeliestOneLeavesWhatThePrecisionSays) {
  const Case c;
  const Discrepancy discrepancy(c.parts, c.row_jitter, c.fields);
  const auto factor = discrepancy.factor(c.weight);
  RandomStream random(2, 0, 0);
  Grid<double> r(34, 23);
  for (double& v : r.data()) v = 3 * normal(random);
  const auto fit = factor->fit(r);
  double left = fit.penalty;
  Grid<double> count = r;
  for (std::size_t i = 0; i < r.size(); ++i) {
    count.data()[i] = c.weight.data()[i] * (r.data()[i] - fit.field.data()[i]);
    left += 0.5 * count.data()[i] * (r.data()[i] - fit.field.data()[i]);
  }
  EXPECT_NEAR(left, 0.5 * dot(r, factor->precision(r)), 1e-9 * left);
  // At the optimum nothing rises through the fit.
  const Grid<double> none = factor->spread(count, fit);
  for (const double s : none.data()) EXPECT_NEAR(s, 0, 1e-9);
}

TEST(Discrepancy, FindsRowsAndFieldsWithoutAnyOtherDiscrepancy) {
  const Case c;
  const auto factor = Discrepancy({}, c.row_jitter, c.fields).factor(Grid<double>(34, 23, 1e6));
  Grid<double> left(34, 23);
  for (int x = 0; x < 34; ++x) left(x, 7) = 1.5 * c.row_jitter(x, 7);
  for (std::size_t i = 0; i < left.size(); ++i) left.data()[i] -= 0.7 * c.fields[1].data()[i];
  const Discrepancy::Factor::Fit fit = factor->fit(left);
  const std::vector<double> rows = factor->rows_of(fit);
  ASSERT_EQ(rows.size(), 23u);
  ASSERT_EQ(fit.coefficients.size(), 25u);
  EXPECT_NEAR(rows[7], 1.5, 1e-4);
  EXPECT_NEAR(rows[6], 0, 1e-4);
  EXPECT_NEAR(fit.coefficients[23], 0, 1e-4);
  EXPECT_NEAR(fit.coefficients[24], -0.7, 1e-4);
}

TEST(Discrepancy, WhatFollowsAFieldIsForetoldWhereNothingIsSeen) {
  const Case c;
  Grid<double> weight = c.weight, left = c.fields[0];
  for (int y = 8; y < 16; ++y)
    for (int x = 8; x < 16; ++x) weight(x, y) = 0;
  for (double& v : left.data()) v *= -1.3;
  const auto foretold = [&](const std::vector<Grid<double>>& fields) {
    const Grid<double> field = Discrepancy(c.parts, {}, fields).factor(weight)->fit(left).field;
    double off = 0;
    for (int y = 10; y < 14; ++y)
      for (int x = 10; x < 14; ++x) off += std::pow(field(x, y) - left(x, y), 2) / 16;
    return std::sqrt(off);
  };
  EXPECT_GT(foretold({}), 2);
  EXPECT_LT(foretold(c.fields), 0.3);
}

TEST(LineJitter, IsTheSlopeAlongRows) {
  PlacedImage image;
  image.values = Grid<double>(40, 9);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 40; ++x) image.values(x, y) = 7.0 * x;
  EXPECT_NEAR(line_jitter(image, 0.3)(20, 4), -2.1, 1e-9);
  EXPECT_THROW(line_jitter(image, -1), InvalidInput);
}

TEST(Discrepancy, DrawsHaveTheDeviationAndTheLengthThatWereAsked) {
  SemDiscrepancy part{Grid<double>(60, 60, 2.0), 6};
  const Discrepancy discrepancy({part});
  const auto factor = discrepancy.factor(Grid<double>(60, 60, 1.0));
  double square = 0, beside = 0, far = 0, n = 0;
  for (std::uint64_t d = 0; d < 60; ++d) {
    const Grid<double> drawn = factor->draw(1, d);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x + 24 < 60; ++x) {
        square += drawn(x, y) * drawn(x, y);
        beside += drawn(x, y) * drawn(x + 3, y);
        far += drawn(x, y) * drawn(x + 24, y);
        n += 1;
      }
  }
  EXPECT_NEAR(std::sqrt(square / n), 2, 0.15);
  EXPECT_GT(beside / square, 0.7);
  EXPECT_LT(std::abs(far / square), 0.1);
}

TEST(UsualDiscrepancy, GrowsWithContrastAndIsNoneForAModelThatIsRight) {
  PlacedImage image;
  image.values = Grid<double>(80, 40, 100);
  for (int y = 0; y < 40; ++y)
    for (int x = 38; x < 42; ++x) image.values(x, y) = 300;
  EXPECT_TRUE(usual_discrepancy(image, 0).empty());
  const auto parts = usual_discrepancy(image, 0.05);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT(parts[0].correlation_px, parts[1].correlation_px);
  EXPECT_GT(parts[0].deviation(40, 20), 5);
  EXPECT_LT(parts[0].deviation(5, 20), 1);
  EXPECT_THROW(usual_discrepancy(image, 1.5), InvalidInput);
}

TEST(ContrastOf, IsTheRmsAboutTheMeanOfPixelsThatCount) {
  PlacedImage image;
  image.values = Grid<double>(80, 40, 100);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) image.values(x, y) = 300;
  EXPECT_NEAR(contrast_of(image), 100, 3);
  image.valid = Mask(80, 40, 1);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) image.valid(x, y) = 0;
  EXPECT_NEAR(contrast_of(image), 0, 1e-9);
}

}  // namespace
}  // namespace surf::reconstruction
