// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "statistics.h"

namespace surf {
namespace {

constexpr int draws = 200'000;

/// The counts of numbers around the middle, those beyond it in the first and last cell.
void expect_drawn(double middle, double spread,
                  const std::function<std::int64_t(RandomStream&)>& draw,
                  const std::function<double(double)>& log_probability) {
  const auto first = static_cast<std::int64_t>(std::max(0.0, std::floor(middle - 6 * spread)));
  const auto cells = static_cast<std::size_t>(std::ceil(12 * spread)) + 3;
  std::vector<std::int64_t> counts(cells);
  std::vector<double> expected(cells);
  RandomStream random(3, 1, static_cast<std::uint64_t>(middle * 16));
  for (int i = 0; i < draws; ++i) {
    const std::int64_t k = draw(random);
    ASSERT_GE(k, 0);
    ++counts[static_cast<std::size_t>(
        std::clamp<std::int64_t>(k - first, 0, static_cast<std::int64_t>(cells) - 1))];
  }
  for (std::size_t i = 0; i < cells; ++i)
    expected[i] =
        draws * std::exp(log_probability(static_cast<double>(first) + static_cast<double>(i)));
  test::expect_distributed(counts, expected, 10);
}

TEST(Distributions, PoissonNumbersAre) {
  for (const double mean : {0.01, 0.7, 9.99, 10.0, 12.5, 40.0, 3000.0}) {
    SCOPED_TRACE(mean);
    expect_drawn(
        mean, std::sqrt(mean), [&](RandomStream& random) { return poisson(mean, random); },
        [&](double k) { return k * std::log(mean) - mean - std::lgamma(k + 1); });
  }
}

TEST(Distributions, BinomialNumbersAre) {
  for (const auto& [n, p] : {std::pair{3, 0.4},
                             {20, 0.05},
                             {25, 0.5},
                             {100, 0.3},
                             {100, 0.97},
                             {40, 0.75},
                             {100'000, 0.002}}) {
    SCOPED_TRACE(testing::Message() << n << " trials of " << p);
    expect_drawn(
        n * p, std::sqrt(n * p * (1 - p)),
        [&, n = n, p = p](RandomStream& random) { return binomial(n, p, random); },
        [&, n = double(n), p = p](double k) {
          if (k > n) return -HUGE_VAL;
          return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                 k * std::log(p) + (n - k) * std::log1p(-p);
        });
  }
}

TEST(Distributions, LargeNumbersHaveTheirMeanAndVariance) {
  RandomStream random(5, 0, 0);
  test::Sample large, seen;
  for (int i = 0; i < 20'000; ++i) {
    large.add(static_cast<double>(poisson(1e9, random)));
    seen.add(static_cast<double>(binomial(2'000'000'000, 0.25, random)));
  }
  test::expect_mean(large.mean(), std::sqrt(1e9 / 20'000), 1e9);
  EXPECT_NEAR(large.standard_error() / std::sqrt(1e9 / 20'000), 1, 0.03);
  test::expect_mean(seen.mean(), std::sqrt(2e9 * 0.25 * 0.75 / 20'000), 5e8);
  EXPECT_NEAR(seen.standard_error() / std::sqrt(2e9 * 0.25 * 0.75 / 20'000), 1, 0.03);
}

TEST(Distributions, EndsAreCertain) {
  RandomStream random(5, 0, 0);
  EXPECT_EQ(poisson(0, random), 0);
  EXPECT_EQ(binomial(0, 0.5, random), 0);
  EXPECT_EQ(binomial(7, 0, random), 0);
  EXPECT_EQ(binomial(7, 1, random), 7);
}

}  // namespace
}  // namespace surf
