// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/noise_correlation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "changing_surface.h"
#include "compare/noise_fields.h"

namespace surf {
namespace {

TEST(NoiseCorrelation, OfBlurredNoiseIsFoundInSpiteOfChanges) {
  constexpr double sigma = 2;
  Grid<double> noise = test::blurred_noise(128, 128, sigma, 3);
  for (int y = 20; y < 40; ++y)
    for (int x = 20; x < 40; ++x) noise(x, y) += 1000;
  const NoiseCorrelation found = estimate_correlation(noise, {}, 12);
  for (const int d : {1, 2, 3})
    EXPECT_NEAR(found.at(d, 0), std::exp(-d * d / (4 * sigma * sigma)), 0.1) << d;
  EXPECT_EQ(found.at(0, 0), 1);
  EXPECT_EQ(found.at(20, 0), 0);
  EXPECT_EQ(found.at(2, 1), found.at(-2, -1));
}

TEST(NoiseCorrelation, OfWhiteNoiseIsNone) {
  const NoiseCorrelation found = estimate_correlation(test::blurred_noise(128, 128, 0, 4), {}, 8);
  EXPECT_NEAR(found.inflation(8), 1, 0.15);
}

TEST(NoiseCorrelation, InflatesMeansAsTheyScatter) {
  const NoiseCorrelation found =
      estimate_correlation(test::blurred_noise(256, 256, 1.5, 5), {}, 10);
  constexpr int size = 6, fields = 200;
  double squares = 0;
  for (int i = 0; i < fields; ++i) {
    const Grid<double> n = test::blurred_noise(size, size, 1.5, 1000 + std::uint64_t(i));
    double sum = 0;
    for (const double v : n.data()) sum += v;
    squares += sum * sum / (size * size);
  }
  EXPECT_NEAR(found.inflation(size) / (squares / fields), 1, 0.45);  // 4.5 standard errors of 0.1
}

TEST(NoiseFields, HaveTheCorrelationThatIsAskedFor) {
  const NoiseCorrelation wanted = estimate_correlation(test::blurred_noise(256, 256, 2, 6), {}, 12);
  const NoiseFields fields(90, 70, wanted);
  double variance = 0, neighbours = 0, across = 0, count = 0;
  for (std::uint64_t i = 0; i < 10; ++i)
    for (const Grid<float>& f : fields.pair(1, i))
      for (int y = 0; y + 1 < 70; ++y)
        for (int x = 0; x + 1 < 90; ++x) {
          variance += f(x, y) * f(x, y);
          neighbours += f(x, y) * f(x + 1, y);
          across += f(x, y) * f(x, y + 1);
          ++count;
        }
  EXPECT_NEAR(variance / count, 1, 0.1);
  EXPECT_NEAR(neighbours / variance, wanted.at(1, 0), 0.05);
  EXPECT_NEAR(across / variance, wanted.at(0, 1), 0.05);
  EXPECT_EQ(fields.pair(1, 3)[0], fields.pair(1, 3)[0]);
  EXPECT_NE(fields.pair(1, 3)[0], fields.pair(2, 3)[0]);
}

TEST(NoiseFields, OfACorrelationThatNoNoiseHasScatterAsItsMeansDo) {
  // As it is estimated from a small view: its spectrum is partly below 0.
  const NoiseCorrelation estimated =
      estimate_correlation(test::blurred_noise(72, 72, 1.5, 8), {}, 14);
  constexpr int size = 9, each = 1000;
  const NoiseFields fields(size, size, estimated);
  double variance = 0, means = 0;
  for (std::uint64_t i = 0; i < each; ++i)
    for (const Grid<float>& f : fields.pair(3, i)) {
      double sum = 0;
      for (const float v : f.data()) sum += double(v), variance += double(v) * double(v);
      means += sum * sum;
    }
  // 2000 means: a standard error of 0.03.
  EXPECT_NEAR(means / variance / estimated.inflation(size), 1, 0.1);
}

}  // namespace
}  // namespace surf
