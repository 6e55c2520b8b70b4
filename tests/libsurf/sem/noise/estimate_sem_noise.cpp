// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/estimate_sem_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sem/noisy_images.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const SemNoise true_noise{0.6, 5, 1e-3};

void expect_finite(const SemNoiseEstimate& e) {
  for (const double v : {e.noise.slope,
                         e.noise.intercept,
                         e.noise.least_variance,
                         e.covariance[0],
                         e.covariance[1],
                         e.covariance[3],
                         e.chi_squared,
                         e.p,
                         e.dispersion,
                         e.curvature_z,
                         e.bend,
                         e.least_mean,
                         e.largest_mean,
                         e.off_line_share,
                         e.correlation_x,
                         e.correlation_y,
                         e.correlation_sum,
                         e.correlation_squares,
                         e.excess_kurtosis,
                         e.quantum})
    EXPECT_TRUE(std::isfinite(v));
  for (const NoisePoint& p : e.points)
    EXPECT_TRUE(std::isfinite(p.mean) && std::isfinite(p.variance) &&
                std::isfinite(p.variance_stderr));
}

TEST(EstimateSemNoise, RecoversTheLineOfAStructuredImage) {
  const Grid<double> mean = test::plateaus(480, 360);
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(test::draw(mean, true_noise, 1)));
  expect_finite(e);
  EXPECT_TRUE(e.slope_known);
  for (const double at : {50.0, 90.0, 140.0})
    EXPECT_NEAR(e.noise.variance(at), true_noise.variance(at), 0.03 * true_noise.variance(at))
        << at;
  EXPECT_GT(e.p, 1e-3);
  EXPECT_LT(std::fabs(e.curvature_z), 4);
  EXPECT_NEAR(e.correlation_squares, 1, 0.01);
  EXPECT_EQ(e.quantum, 0);
  EXPECT_EQ(e.off_line_share, 0);
  EXPECT_THAT(e.warnings, IsEmpty());
  // The ripple over the right quarter is not flat.
  const auto rippled =
      std::ranges::count_if(e.points, [](const NoisePoint& p) { return p.region.x0 >= 368; });
  EXPECT_LT(rippled, 5);
  EXPECT_GT(e.points.size(), 100u);
}

// What is claimed of the errors, over many images: neither line nor errors are off.
TEST(EstimateSemNoise, IntervalsCoverTheTruthOnStructuredImages) {
  const Grid<double> mean = test::plateaus(300, 240);
  constexpr int images = 200;
  test::Sample low, high, share;
  int covered_slope = 0, covered_low = 0;
  for (int i = 0; i < images; ++i) {
    const SemNoiseEstimate e =
        estimate_sem_noise(test::placed(test::draw(mean, true_noise, 100 + i)));
    covered_slope += std::fabs(e.noise.slope - true_noise.slope) <= 1.96 * e.slope_stderr();
    covered_low +=
        std::fabs(e.noise.variance(60) - true_noise.variance(60)) <= 1.96 * e.variance_stderr(60);
    low.add(e.noise.variance(60) / true_noise.variance(60));
    high.add(e.noise.variance(140) / true_noise.variance(140));
    share.add(e.p < 0.05);
  }
  RecordProperty("covered_slope", covered_slope);
  RecordProperty("covered_low", covered_low);
  EXPECT_GE(covered_slope, 178);  // 95 %: 190 of 200, and four standard deviations of that
  EXPECT_GE(covered_low, 178);
  EXPECT_NEAR(low.mean(), 1, 0.01);
  EXPECT_NEAR(high.mean(), 1, 0.01);
  EXPECT_LT(share.mean(), 0.15);
}

// Without structure choosing must not shrink the variance, and p is uniform.
TEST(EstimateSemNoise, ChoosingBlocksDoesNotBiasFlatImages) {
  constexpr int images = 300;
  test::Sample ratio, z;
  std::vector<std::int64_t> counts(10);
  for (int i = 0; i < images; ++i) {
    Grid<double> mean(160, 160);
    for (int y = 0; y < 160; ++y)
      for (int x = 0; x < 160; ++x) mean(x, y) = 40 + 0.5 * x;
    const SemNoiseEstimate e =
        estimate_sem_noise(test::placed(test::draw(mean, true_noise, 1000 + i)));
    ratio.add(e.noise.variance(80) / true_noise.variance(80));
    z.add((e.noise.slope - true_noise.slope) / e.slope_stderr());
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(10 * e.p), 9)];
  }
  test::expect_mean(ratio.mean(), ratio.standard_error(), 1, 2);
  test::expect_mean(z.mean(), z.standard_error(), 0, 2);
  test::expect_distributed(counts, std::vector<double>(10, images / 10.0), 2);
}

TEST(EstimateSemNoise, AGammaIsSeen) {
  Grid<double> image = test::draw(test::plateaus(480, 360), true_noise, 1);
  for (double& v : image.data()) v = 255 * std::pow(std::fmax(v, 0) / 255, 0.5);
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(image));
  expect_finite(e);
  EXPECT_THAT(e.warnings, Not(IsEmpty()));
  EXPECT_LT(e.noise.slope, 0.1);  // the law is lost
}

TEST(EstimateSemNoise, RegionsOfAUser) {
  const Grid<double> mean = test::plateaus(480, 360);
  SemNoiseOptions options;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      options.regions.push_back(
          {column * 120 + 78, row * 120 + 78, column * 120 + 102, row * 120 + 102});
  constexpr int images = 100;
  int covered = 0;
  test::Sample ratio;
  for (int i = 0; i < images; ++i) {
    const SemNoiseEstimate e =
        estimate_sem_noise(test::placed(test::draw(mean, true_noise, 50 + i)), options);
    EXPECT_EQ(e.points.size(), 9u);
    EXPECT_EQ(e.degrees, 7);
    EXPECT_EQ(e.pixels, 9 * 24 * 24);
    covered += std::fabs(e.noise.slope - true_noise.slope) <= 1.96 * e.slope_stderr();
    ratio.add(e.noise.variance(90) / true_noise.variance(90));
  }
  EXPECT_GE(covered, 86);
  test::expect_mean(ratio.mean(), ratio.standard_error(), 1, 1);
}

TEST(EstimateSemNoise, OneRegionGivesAConstant) {
  const Grid<double> mean = test::plateaus(480, 360);
  SemNoiseOptions options;
  options.regions = {{78, 78, 102, 102}};
  const SemNoiseEstimate e =
      estimate_sem_noise(test::placed(test::draw(mean, true_noise, 1)), options);
  expect_finite(e);
  EXPECT_FALSE(e.slope_known);
  EXPECT_EQ(e.noise.slope, 0);
  EXPECT_EQ(e.degrees, 0);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("taken as constant")));
}

TEST(EstimateSemNoise, ImagesOfOneColourGiveAConstant) {
  const SemNoise noise{0, 9, 1e-3};
  const SemNoiseEstimate e =
      estimate_sem_noise(test::placed(test::draw(Grid<double>(200, 200, 50), noise, 1)));
  expect_finite(e);
  EXPECT_FALSE(e.slope_known);
  EXPECT_NEAR(e.noise.intercept, 9, 5 * e.intercept_stderr());
  EXPECT_NEAR(e.intercept_stderr(), 9 * std::sqrt(2.0 / static_cast<double>(e.pixels)), 0.01);
  EXPECT_GT(e.pixels, 15000);
}

// A moving mean of 3 pixels along rows: 2/3 and 1/3 one and two pixels away.
TEST(EstimateSemNoise, SeesThatAnImageWasFiltered) {
  const Grid<double> mean = test::plateaus(482, 360);
  const Grid<double> image = test::draw(mean, true_noise, 4);
  Grid<double> filtered(480, 360);
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 480; ++x)
      filtered(x, y) = (image(x, y) + image(x + 1, y) + image(x + 2, y)) / 3;
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(filtered));
  EXPECT_NEAR(e.correlation_x, 2.0 / 3, 0.02);
  EXPECT_NEAR(e.correlation_y, 0, 0.02);
  EXPECT_NEAR(e.correlation_sum, 3, 0.2);
  EXPECT_NEAR(e.correlation_squares, 1 + 2 * (4.0 / 9 + 1.0 / 9), 0.05);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("correlated")));
  for (const double at : {60.0, 120.0})
    EXPECT_NEAR(e.noise.variance(at), true_noise.variance(at) / 3,
                0.06 * true_noise.variance(at) / 3);
  EXPECT_GT(e.p, 1e-4);
}

TEST(EstimateSemNoise, LineBelowZeroInTheImageIsReported) {
  // Counts with a gain of 1, shown with 40 taken off: variance = mean + 40 - 40; here too much is
  // taken off.
  const SemNoise noise{1, -60, 1e-3};
  const Grid<double> mean = test::plateaus(480, 360);
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(test::draw(mean, noise, 4)));
  expect_finite(e);
  EXPECT_NEAR(e.noise.slope, 1, 5 * e.slope_stderr());
  EXPECT_LT(e.noise.intercept, 0);
  EXPECT_GT(e.off_line_share, 0.05);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("least variance")));
  EXPECT_GE(e.noise.variance(0), e.noise.least_variance);
  EXPECT_GT(e.noise.least_variance, 0);
}

TEST(EstimateSemNoise, QuantisationIsPartOfTheNoise) {
  const SemNoise noise{0.02, 0, 1e-3};  // standard deviations of 0.9 to 1.7 grey levels
  const Grid<double> mean = test::plateaus(480, 360);
  const SemNoiseEstimate e =
      estimate_sem_noise(test::placed(test::rounded(test::draw(mean, noise, 4), 0, 255)));
  EXPECT_EQ(e.quantum, 1);
  for (const double at : {60.0, 120.0})
    EXPECT_NEAR(e.noise.variance(at), noise.variance(at) + 1.0 / 12, 0.06);
  const SemNoise coarse{0.002, 0, 1e-3};
  EXPECT_THAT(
      estimate_sem_noise(test::placed(test::rounded(test::draw(mean, coarse, 4), 0, 255))).warnings,
      Contains(HasSubstr("steps of the grey levels")));
}

TEST(EstimateSemNoise, SaturatedPixelsAreLeftOut) {
  const Grid<double> mean = test::plateaus(480, 360);
  const PlacedImage image = test::placed(test::rounded(test::draw(mean, true_noise, 4), 0, 130));
  const SemNoiseEstimate e = estimate_sem_noise(image);
  EXPECT_GT(e.white, 10000);
  EXPECT_EQ(e.black, 0);
  EXPECT_THAT(e.warnings, Contains(HasSubstr("saturated")));
  EXPECT_LT(e.largest_mean, 122);
  for (const double at : {50.0, 100.0})
    EXPECT_NEAR(e.noise.variance(at), true_noise.variance(at), 0.04 * true_noise.variance(at))
        << at;
  // Told that nothing is saturated, it believes it: the bright plateaus seem to have little noise.
  SemNoiseOptions options;
  options.white = std::numeric_limits<double>::infinity();
  EXPECT_EQ(estimate_sem_noise(image, options).white, 0);
}

TEST(EstimateSemNoise, CountsAreNotTakenForSaturation) {
  // Poisson counts of mean 1: most pixels are 0 and 1, and that is the law, not a clipped scale.
  Grid<double> image(200, 200);
  RandomStream random(3, 0, 0);
  for (double& v : image.data()) {
    double product = random.uniform();
    for (; product > std::exp(-1.0); product *= random.uniform()) v += 1;
  }
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(image));
  EXPECT_EQ(e.black, 0);
  EXPECT_NEAR(e.noise.variance(1), 1, 0.03);
  EXPECT_NEAR(e.excess_kurtosis, 1, 0.25);
}

TEST(EstimateSemNoise, HolesDoNotCount) {
  const Grid<double> mean = test::plateaus(480, 360);
  PlacedImage image = test::placed(test::draw(mean, true_noise, 1));
  image.valid = Mask(480, 360, 1);
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 240; ++x)
      image.valid(x, y) = 0, image.values(x, y) = std::numeric_limits<double>::quiet_NaN();
  const SemNoiseEstimate e = estimate_sem_noise(image);
  expect_finite(e);
  for (const NoisePoint& p : e.points) EXPECT_GE(p.region.x0, 240);
}

TEST(EstimateSemNoise, SaysWhatIsWrongWithHopelessImages) {
  const auto message = [](const Grid<double>& image,
                          const SemNoiseOptions& options = {}) -> std::string {
    try {
      expect_finite(estimate_sem_noise(test::placed(image), options));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(Grid<double>(200, 200, 7)), HasSubstr("there is no noise"));
  EXPECT_THAT(message(test::plateaus(20, 20)), HasSubstr("no 5 flat places of 8 x 8"));
  EXPECT_THAT(message(Grid<double>(5, 5, 7)), HasSubstr("there is no noise"));
  Grid<double> halves(200, 200, 0);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 100; ++x) halves(x, y) = 255;
  EXPECT_THAT(message(halves), Not(HasSubstr("nan")));
  SemNoiseOptions outside;
  outside.regions = {{0, 0, 10, 10}, {190, 190, 210, 200}};
  const Grid<double> noisy = test::draw(Grid<double>(200, 200, 50), true_noise, 1);
  EXPECT_THAT(message(noisy, outside), HasSubstr("region 2: columns 190 to 210"));
  outside.regions = {{0, 0, 3, 3}};
  EXPECT_THAT(message(noisy, outside), HasSubstr("9 pixels of it are valid"));
  outside.regions = {{5, 5, 5, 9}};
  EXPECT_THAT(message(noisy, outside), HasSubstr("region 1"));
  SemNoiseOptions bad;
  bad.block_px = 3;
  EXPECT_THROW(estimate_sem_noise(test::placed(noisy), bad), UsageError);
  bad = {};
  bad.degree = 3;
  EXPECT_THROW(estimate_sem_noise(test::placed(noisy), bad), UsageError);
  bad = {};
  bad.black = 3, bad.white = 2;
  EXPECT_THROW(estimate_sem_noise(test::placed(noisy), bad), UsageError);
}

// The line does not depend on the units of the image.
TEST(EstimateSemNoise, FollowsTheUnitsOfTheImage) {
  const Grid<double> image = test::draw(test::plateaus(300, 240), true_noise, 4);
  const SemNoiseEstimate e = estimate_sem_noise(test::placed(image));
  Grid<double> other = image;
  for (double& v : other.data()) v = 1e-4 * v - 3;
  const SemNoiseEstimate o = estimate_sem_noise(test::placed(other));
  EXPECT_NEAR(o.noise.slope, 1e-4 * e.noise.slope, 1e-10);
  EXPECT_NEAR(o.noise.variance(1e-4 * 90 - 3), 1e-8 * e.noise.variance(90), 1e-13);
  EXPECT_NEAR(o.chi_squared, e.chi_squared, 1e-3);
}

}  // namespace
}  // namespace surf
