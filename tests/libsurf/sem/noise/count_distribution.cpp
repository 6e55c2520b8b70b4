// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/count_distribution.h"

#include <algorithm>
#include <cmath>

#include "sem/noisy_images.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf {
namespace {

void count(CountHistogram& counts, std::int64_t value) {
  const auto k = static_cast<std::size_t>(value);
  if (counts.size() <= k) counts.resize(k + 1);
  ++counts[k];
}

CountHistogram poisson_counts(double mean, int trials, std::uint64_t seed) {
  CountHistogram counts;
  RandomStream random(seed, 0, 0);
  for (int i = 0; i < trials; ++i) {
    std::int64_t k = 0;
    for (double product = random.uniform(); product > std::exp(-mean); product *= random.uniform())
      ++k;
    count(counts, k);
  }
  return counts;
}

CountHistogram log_normal_counts(const LogNormalCounts& d, int trials, std::uint64_t seed) {
  CountHistogram counts;
  RandomStream random(seed, 0, 0);
  for (int i = 0; i < trials; ++i) {
    const double z = test::normal(random);
    count(counts, std::max<std::int64_t>(
                      0, std::llround(d.median + d.scale * std::expm1(d.shape * z) / d.shape)));
  }
  return counts;
}

template <class Distribution>
double total(const Distribution& d) {
  double sum = 0;
  for (int k = 0; k < 5000; ++k) sum += d.probability(k);
  return sum;
}

TEST(CountDistribution, ProbabilitiesAddUpToOne) {
  EXPECT_NEAR(total(PoissonCounts{3.7}), 1, 1e-12);
  EXPECT_NEAR(total(PoissonCounts{0}), 1, 1e-12);
  EXPECT_NEAR(total(LogNormalCounts{0.3, 1.2, 0.6}), 1, 1e-12);
  EXPECT_NEAR(total(LogNormalCounts{30, 5, 0}), 1, 1e-12);
  EXPECT_NEAR(total(NormalCounts{0.4, 2}), 1, 1e-12);
  // The far tail is not lost to rounding.
  EXPECT_GT((LogNormalCounts{30, 1, 0}.probability(50)), 0);
  EXPECT_EQ((LogNormalCounts{30, 1, 0.5}.probability(3)), 0);  // it begins at 28
}

TEST(CountDistribution, MomentsAreThose) {
  const CountMoments m = moments({50, 100, 50});
  EXPECT_EQ(m.trials, 200);
  EXPECT_DOUBLE_EQ(m.mean, 1);
  EXPECT_DOUBLE_EQ(m.variance, 100.0 / 199);
  EXPECT_DOUBLE_EQ(m.skewness, 0);
}

TEST(CountDistribution, PoissonIsRecovered) {
  test::Sample mean;
  std::vector<std::int64_t> of_p(10);
  constexpr int sets = 400;
  for (std::uint64_t i = 0; i < sets; ++i) {
    const CountHistogram counts = poisson_counts(2.3, 2000, i);
    const PoissonCounts d = fit_poisson(counts);
    mean.add(d.mean);
    ++of_p[std::min<std::size_t>(static_cast<std::size_t>(10 * test_fit(counts, d).p), 9)];
  }
  test::expect_mean(mean.mean(), std::sqrt(2.3 / 2000 / sets), 2.3, 2);
  test::expect_distributed(of_p, std::vector<double>(10, sets / 10.0), 2);
}

TEST(CountDistribution, LogNormalIsRecovered) {
  const LogNormalCounts truth{12, 4, 0.4};
  test::Sample median, scale, shape;
  std::vector<std::int64_t> of_p(8);
  constexpr int sets = 200;
  for (std::uint64_t i = 0; i < sets; ++i) {
    const CountHistogram counts = log_normal_counts(truth, 5000, i);
    const LogNormalCounts d = fit_log_normal(counts);
    median.add(d.median), scale.add(d.scale), shape.add(d.shape);
    EXPECT_GE(log_likelihood(counts, d), log_likelihood(counts, truth));
    ++of_p[std::min<std::size_t>(static_cast<std::size_t>(8 * test_fit(counts, d).p), 7)];
  }
  // Estimates of greatest likelihood are off by less than their own scatter over the root of the
  // trials.
  test::expect_mean(median.mean(), median.standard_error(), 12, 4, 0.01);
  test::expect_mean(scale.mean(), scale.standard_error(), 4, 4, 0.01);
  test::expect_mean(shape.mean(), shape.standard_error(), 0.4, 4, 0.003);
  test::expect_distributed(of_p, std::vector<double>(8, sets / 8.0), 4);
}

TEST(CountDistribution, LogNormalFitIsAMaximum) {
  for (const LogNormalCounts& truth :
       {LogNormalCounts{0.2, 0.8, 0.7}, LogNormalCounts{80, 12, 0.1}}) {
    const CountHistogram counts = log_normal_counts(truth, 10000, 3);
    const LogNormalCounts d = fit_log_normal(counts);
    const double largest = log_likelihood(counts, d);
    for (const double f : {0.99, 1.01}) {
      EXPECT_LT(log_likelihood(counts, {d.median * f, d.scale, d.shape}), largest);
      EXPECT_LT(log_likelihood(counts, {d.median, d.scale * f, d.shape}), largest);
      EXPECT_LE(log_likelihood(counts, {d.median, d.scale, d.shape * f}), largest);
    }
    EXPECT_GT(test_fit(counts, d).p, 1e-4);
  }
}

TEST(CountDistribution, TellsOneFromTheOther) {
  const CountHistogram skewed = log_normal_counts({12, 4, 0.5}, 10000, 1);
  EXPECT_LT(test_fit(skewed, fit_poisson(skewed)).p, 1e-6);
  EXPECT_LT(test_fit(skewed, fit_normal(skewed)).p, 1e-6);
  const CountHistogram poisson = poisson_counts(400, 10000, 1);
  EXPECT_GT(test_fit(poisson, fit_poisson(poisson)).p, 1e-4);
  EXPECT_GT(test_fit(poisson, fit_log_normal(poisson)).p, 1e-4);
}

TEST(CountDistribution, OddHistogramsDoNoHarm) {
  EXPECT_THROW(moments({10}), InvalidInput);
  EXPECT_THROW(moments({-1, 500}), InvalidInput);
  EXPECT_THROW(moments({}), InvalidInput);
  EXPECT_THROW(fit_log_normal({0, 0, 500}), InvalidInput);
  EXPECT_THROW(fit_normal({500}), InvalidInput);
  EXPECT_EQ(fit_poisson({500}).mean, 0);
  EXPECT_EQ(test_fit({500}, fit_poisson({500})).degrees, 0);
  for (const CountHistogram& counts :
       {CountHistogram{400, 100}, CountHistogram{0, 500, 1}, CountHistogram{499, 0, 0, 0, 1},
        CountHistogram{250, 0, 250}}) {
    const LogNormalCounts d = fit_log_normal(counts);
    EXPECT_TRUE(std::isfinite(d.median) && d.scale > 0 && d.shape >= 0);
    const CountFit fit = test_fit(counts, d);
    EXPECT_TRUE(std::isfinite(fit.chi_squared) && fit.p >= 0 && fit.p <= 1);
  }
}

}  // namespace
}  // namespace surf
