// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/guided_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "sem/guided/convex_weights.h"
#include "sem/guided/guided_tile.h"
#include "sem/guided/local_regression.h"
#include "surf/core/distributions.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

using Field = std::function<double(int x, int y)>;

Grid<double> sampled(int width, int height, const Field& field) {
  Grid<double> grid(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) grid(x, y) = field(x, y);
  return grid;
}

/// Counts of primaries that send a Poisson number of electrons to the detector.
CountImage counts_of(const Grid<double>& yield, int primaries, std::uint64_t seed) {
  CountImage counts;
  for (std::size_t h = 0; h < 2; ++h) {
    for (auto* plane : {&counts[h].primaries, &counts[h].sum, &counts[h].squares})
      *plane = Grid<double>(yield.width(), yield.height(), 0.0);
    for (std::size_t i = 0; i < yield.size(); ++i) {
      RandomStream random(seed, i, h);
      counts[h].primaries.data()[i] = primaries / 2;
      for (int k = 0; k < primaries / 2; ++k) {
        const auto n = static_cast<double>(poisson(yield.data()[i], random));
        counts[h].sum.data()[i] += n;
        counts[h].squares.data()[i] += n * n;
      }
    }
  }
  return counts;
}

Grid<double> plain(const CountImage& c) {
  Grid<double> mean = c[0].sum;
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean.data()[i] = (c[0].sum.data()[i] + c[1].sum.data()[i]) /
                     (c[0].primaries.data()[i] + c[1].primaries.data()[i]);
  return mean;
}

double rms(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a.data()[i] - b.data()[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double root_mean_square(const Grid<double>& a) {
  return rms(a, Grid<double>(a.width(), a.height()));
}

double waves(int x, int y) {
  return 0.6 + 0.2 * std::sin(0.15 * x) * std::cos(0.11 * y + 0.05 * x);
}

// Unlike at each pixel, and known to nobody.
double speckle(int x, int y) {
  return RandomStream(7, static_cast<std::uint64_t>(1000 * y + x), 0).uniform() < 0.5 ? 0.2 : 2.0;
}

TEST(GuidedEstimate, TakesWideWindowsWhereNothingChanges) {
  const Grid<double> yield(96, 80, 0.4);
  const CountImage counts = counts_of(yield, 32, 1);
  const GuidedImage image = estimate_guided(counts, {});
  EXPECT_LT(rms(image.mean, yield), 0.1 * rms(plain(counts), yield));
  EXPECT_NEAR(image.noise_scale, 1, 0.05);
  EXPECT_GT(image.radius_px(48, 40), 8);
  EXPECT_GT(std::pow(rms(plain(counts), yield) / root_mean_square(image.error), 2), 50);
}

TEST(GuidedEstimate, FollowsAGuideThroughDetailThatWindowsWouldBlur) {
  const Grid<double> yield = sampled(96, 96, [](int x, int y) {
    return 0.5 + 0.3 * std::sin(1.3 * x) * std::sin(1.1 * y) + 0.001 * x;
  });
  // Right but for its contrast and a slow drift.
  Guide guide{"model", yield, true};
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) guide.values(x, y) = 0.2 + 0.7 * yield(x, y) - 0.002 * y;
  const CountImage counts = counts_of(yield, 64, 2);
  const double with = rms(estimate_guided(counts, {guide}).mean, yield),
               without = rms(estimate_guided(counts, {}).mean, yield);
  EXPECT_LT(with, 0.2 * rms(plain(counts), yield));
  EXPECT_LT(with, 0.3 * without);
}

TEST(GuidedEstimate, StaysWithTheCountsWhereGuidesAndNeighboursLie) {
  const Grid<double> yield = sampled(96, 96, speckle);
  const Guide lie{"lie", sampled(96, 96, waves), true},
      other{"other", sampled(96, 96, [](int x, int y) { return double((x * 7 + y * 13) % 5); })};
  for (const std::uint64_t seed : {3, 4, 5}) {
    const CountImage counts = counts_of(yield, 64, seed);
    EXPECT_LT(rms(estimate_guided(counts, {lie, other}).mean, yield),
              1.05 * rms(plain(counts), yield));
  }
}

TEST(GuidedEstimate, GuidesOfTheSameElectronsAreCrossed) {
  // What another detector saw of the same electrons says nothing of the yield, only of the noise.
  const Grid<double> yield(96, 96, 0.4);
  const CountImage counts = counts_of(yield, 64, 17);
  std::array<Grid<double>, 2> noisy;
  for (std::size_t h = 0; h < 2; ++h) {
    noisy[h] = counts[h].sum;
    for (double& n : noisy[h].data()) n /= 32;
  }
  const GuidedImage crossed = estimate_guided(counts, {{"other", noisy[1], false, noisy[0]}}),
                    straight = estimate_guided(counts, {{"other", noisy[0], false, noisy[1]}});
  EXPECT_LT(rms(crossed.mean, yield), 0.2 * rms(plain(counts), yield));
  EXPECT_LT(rms(crossed.mean, yield), 1.3 * root_mean_square(crossed.error));
  EXPECT_GT(rms(straight.mean, yield), 3 * rms(crossed.mean, yield));
}

TEST(GuidedEstimate, KeepsASinglePixelThatStandsOut) {
  Grid<double> yield(96, 96, 0.4);
  yield(50, 40) = 6;
  const CountImage counts = counts_of(yield, 128, 6);
  const GuidedImage image = estimate_guided(counts, {});
  EXPECT_GT(image.mean(50, 40), 4.5);
  EXPECT_GT(image.error(50, 40), 3 * image.error(20, 20));
}

TEST(GuidedEstimate, KeepsOfAFaintPixelWhatItsCountsCannotBe) {
  Grid<double> yield(96, 96, 0.4);
  yield(50, 40) = 1.2;  // 14 standard deviations of a pixel's counts; too little for a window
  double sum = 0;
  for (const std::uint64_t seed : {6, 7, 8, 9})
    sum += estimate_guided(counts_of(yield, 128, seed), {}).mean(50, 40);
  EXPECT_GT(sum / 4, 0.8);
}

/// Squared errors of images of 64 primaries per pixel, pooled over four seeds.
struct Pooled {
  double errors = 0, stated = 0, without = 0;

  explicit Pooled(const Grid<double>& yield) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const CountImage counts = counts_of(yield, 64, seed);
      const GuidedImage image = estimate_guided(counts, {});
      errors += std::pow(rms(image.mean, yield), 2);
      stated += std::pow(root_mean_square(image.error), 2);
      without += std::pow(rms(plain(counts), yield), 2);
    }
  }
};

TEST(GuidedEstimate, SingleCountsInTheDarkAreChance) {
  // 0.06 counts per pixel: each lies far beyond what a normal distribution would allow.
  const auto [errors, stated, without] = Pooled(Grid<double>(96, 96, 1e-3));
  EXPECT_LT(errors, 0.05 * without);
  EXPECT_GT(std::sqrt(errors / stated), 0.5);
  EXPECT_LT(std::sqrt(errors / stated), 1.5);
}

TEST(GuidedEstimate, FewBrightPlacesAmongDarkOnesAreKeptAndDoubted) {
  // As facets that a mirror-like detector sees: 5 x 5 pixels of 0.03 to 30 counts each, a
  // thousandth of that around. Of 0.03 counts per bright pixel, some fifteen in an image, chance
  // alone makes the stated error what it is.
  for (const auto& [bright, most] :
       {std::pair{0.0005, 2.5}, {0.005, 1.3}, {0.05, 1.3}, {0.5, 1.3}}) {
    const auto [errors, stated, without] = Pooled(sampled(96, 96, [bright = bright](int x, int y) {
      return bright * (x % 24 / 5 == 2 && y % 24 / 5 == 2 ? 1 : 1e-3);
    }));
    EXPECT_LT(std::sqrt(errors / without), 1.05) << bright;
    EXPECT_GT(std::sqrt(errors / stated), 0.8) << bright;
    EXPECT_LT(std::sqrt(errors / stated), most) << bright;
  }
}

TEST(GuidedEstimate, RegionsDoNotMix) {
  Grid<int> region(96, 64, 1);
  Grid<double> yield(96, 64, 0.2);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      if (x >= 48) yield(x, y) = 2, region(x, y) = 4;
      if (y < 8) region(x, y) = -1;
    }
  const CountImage counts = counts_of(yield, 64, 7);
  const GuidedImage image = estimate_guided(counts, {}, {.region = region});
  for (int y = 8; y < 64; ++y) {
    EXPECT_NEAR(image.mean(47, y), 0.2, 0.03);
    EXPECT_NEAR(image.mean(48, y), 2, 0.1);
  }
  EXPECT_EQ(image.mean(10, 3), 0);
  EXPECT_EQ(image.error(10, 3), 0);
}

TEST(GuidedEstimate, SaysHowFarOffItIs) {
  // Pooled over seeds: the root mean square error over the stated one.
  for (const auto& [field, low, high] :
       {std::tuple<Field, double, double>{[](int, int) { return 0.4; }, 0.6, 1.2},
        {waves, 0.8, 1.25},
        // Finer than windows: all estimates are off alike, and lie close together.
        {[](int x, int y) { return 0.5 + 0.08 * std::sin(2.1 * x + 0.3 * y) * std::sin(1.9 * y); },
         0.9, 1.4},
        {speckle, 0.9, 1.1}}) {
    const Grid<double> yield = sampled(96, 96, field);
    double errors = 0, stated = 0;
    for (std::uint64_t seed = 10; seed < 18; ++seed) {
      const GuidedImage image = estimate_guided(counts_of(yield, 32, seed), {});
      errors += std::pow(rms(image.mean, yield), 2);
      stated += std::pow(root_mean_square(image.error), 2);
    }
    EXPECT_GT(std::sqrt(errors / stated), low);
    EXPECT_LT(std::sqrt(errors / stated), high);
  }
}

TEST(GuidedEstimate, AddsWhatTheLibraryLeavesUnknown) {
  const CountImage counts = counts_of(Grid<double>(64, 64, 0.5), 32, 20);
  const GuidedImage without = estimate_guided(counts, {}),
                    with = estimate_guided(counts, {}, {.library_cascades = 5000});
  // How well the noise is known differs, and with it the weights, by little.
  EXPECT_LT(rms(with.mean, without.mean), 1e-3);
  EXPECT_NEAR(std::pow(with.error(30, 30), 2) - std::pow(without.error(30, 30), 2), 0.5 / 5000,
              0.2 * 0.5 / 5000);
}

TEST(GuidedEstimate, DoesNotDependOnThreads) {
  const Guide guide{"guide", sampled(300, 40, [](int x, int y) { return waves(x + 3, y); })};
  const CountImage counts = counts_of(sampled(300, 40, waves), 16, 21);
  const GuidedImage one = estimate_guided(counts, {guide}, {.threads = 1}),
                    three = estimate_guided(counts, {guide}, {.threads = 3});
  EXPECT_EQ(one.mean, three.mean);
  EXPECT_EQ(one.error, three.error);
  EXPECT_EQ(one.radius_px, three.radius_px);
}

TEST(GuidedTile, TilesHaveNoSeams) {
  constexpr int width = 220, height = 90;
  const CountImage counts = counts_of(sampled(width, height, waves), 16, 22);
  guided::GuidedRegion r;
  r.counts = guided::region_counts(counts, {}, 0);
  for (auto& guides : r.guides)
    guides.push_back(
        sampled(width, height, [](int x, int y) { return 5 * waves(x + 3, y) - 3; }).data());
  r.weight.assign(r.counts.seen.size(), 1.0);
  for (std::size_t h = 0; h < 2; ++h)
    r.noise[h] = r.raw_noise[h] = std::vector<double>(r.weight.size(), 0.07);
  for (std::size_t i = 0; i < r.weight.size(); ++i)
    r.detail.push_back(static_cast<double>(i % 7) / 3);
  const auto estimate = [&](const std::vector<guided::PixelRange>& tiles) {
    guided::GuidedPlanes planes;
    planes.spread.assign(r.weight.size(), 0.0);
    for (guided::HalfPlanes& half : planes.halves)
      half.value = half.variance = half.leverage = planes.spread;
    for (const guided::PixelRange& tile : tiles) guided::estimate_tile(r, tile, 2, planes);
    return planes;
  };
  const auto whole = estimate({{0, 0, width, height}}),
             parts = estimate({{0, 0, 100, 64}, {100, 0, width, 64}, {0, 64, width, height}});
  for (std::size_t i = 0; i < r.weight.size(); ++i) {
    EXPECT_NEAR(whole.halves[0].value[i], parts.halves[0].value[i], 1e-9);
    EXPECT_NEAR(whole.halves[1].variance[i], parts.halves[1].variance[i], 1e-9);
    EXPECT_NEAR(whole.spread[i], parts.spread[i], 1e-9);
  }
}

TEST(GuidedEstimate, EmptyCountsAreZeroNotNaN) {
  const GuidedImage image = estimate_guided(counts_of(Grid<double>(40, 40, 0.0), 8, 1), {});
  for (const double v : image.mean.data()) EXPECT_EQ(v, 0);
  for (const double v : image.error.data()) EXPECT_TRUE(std::isfinite(v));
}

TEST(GuidedEstimate, IsWatchedAndRefusesBadInput) {
  const CountImage counts = counts_of(Grid<double>(20, 16, 0.5), 8, 1);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(estimate_guided(counts, {}, {.watch = {{}, &cancel}}), Interrupted);
  EXPECT_THROW(estimate_guided({}, {}), InvalidInput);
  CountImage bad = counts;
  bad[1].sum = Grid<double>(16, 20);
  EXPECT_THROW(estimate_guided(bad, {}), InvalidInput);
  bad = counts;
  bad[0].squares(3, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(estimate_guided(bad, {}), InvalidInput);
  EXPECT_THROW(estimate_guided(counts, {{"small", Grid<double>(2, 2)}}), InvalidInput);
  EXPECT_THROW(estimate_guided(counts, std::vector<Guide>(16, {"g", Grid<double>(20, 16)})),
               InvalidInput);
  EXPECT_THROW(estimate_guided(counts, {}, {.region = Grid<int>(3, 3)}), InvalidInput);
}

TEST(ConvexWeights, FindTheLeastOnTheSimplex) {
  const std::vector<double> matrix{2, 0, 0, 0, 1, 0, 0, 0, 4};
  const std::vector<double> none{0, 0, 0};
  const std::vector<double> a = guided::convex_weights(matrix, none);
  EXPECT_NEAR(a[0], 2.0 / 7, 1e-4);  // as 1 / 2, 1, 1 / 4
  EXPECT_NEAR(a[1], 4.0 / 7, 1e-4);
  EXPECT_NEAR(a[2], 1.0 / 7, 1e-4);
  EXPECT_THAT(guided::convex_weights(matrix, std::vector<double>{9, 0, 9}),
              testing::Pointwise(testing::DoubleNear(1e-6), {0.0, 1.0, 0.0}));
  EXPECT_THAT(guided::convex_weights(std::vector<double>(4, 0.0), std::vector<double>{2, 1}),
              testing::ElementsAre(0, 1));
}

TEST(LocalRegression, FollowsALinearFunctionOfItsGuide) {
  guided::LocalData data{32, 24, {}, {}, {{}}};
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      data.guides[0].push_back(std::sin(0.9 * x) + std::cos(0.7 * y));
      data.target.push_back(3 + 0.5 * data.guides[0].back());
      data.precision.push_back(x < 30 ? 1.0 : 0.0);
    }
  const std::vector<std::vector<int>> sets{{}, {0}};
  const auto fits = guided::fit_locally(data, 3, {0, 0, 32, 24}, sets, 1);
  const std::size_t middle = 12 * 32 + 16;
  EXPECT_NEAR(fits[1].value[middle], data.target[middle], 0.02);
  // Of a mean in a Gaussian window: 1 / (4 pi sigma^2); the leverage is twice that.
  EXPECT_NEAR(fits[0].variance[middle], 1 / (4 * M_PI * 9), 1e-4);
  EXPECT_NEAR(fits[0].leverage[middle], 1 / (2 * M_PI * 9), 1e-4);
  // Its derivative by the target of the same pixel.
  data.target[middle] += 1;
  const auto moved = guided::fit_locally(data, 3, {0, 0, 32, 24}, sets, 1);
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_NEAR(moved[s].value[middle] - fits[s].value[middle], fits[s].leverage[middle], 1e-12);
}

}  // namespace
}  // namespace surf
