// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/calibration.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "statistics.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) *
         std::cos(2 * std::numbers::pi * random.uniform());
}

/// SE and BSE of something with relief, with the given correlation of what is left beside their
/// means.
CalibrationImages two_channels(int width, int height, double correlation) {
  CalibrationImages images;
  images.channels = {"SE", "BSE"};
  images.simulated.assign(2, Grid<double>(width, height));
  images.real = Grid<double>(width, height);
  RandomStream random(7, 0, 0);
  for (std::size_t i = 0; i < images.real.size(); ++i) {
    const double a = normal(random), b = normal(random);
    images.simulated[0].data()[i] = 0.9 + 0.2 * a;
    images.simulated[1].data()[i] =
        0.25 +
        0.05 * (correlation * a + std::sqrt(std::fmax(0, 1 - correlation * correlation)) * b);
  }
  return images;
}

void expose(CalibrationImages& images, double se, double bse, double offset, double noise,
            std::uint64_t seed) {
  RandomStream random(seed, 1, 0);
  for (std::size_t i = 0; i < images.real.size(); ++i)
    images.real.data()[i] = se * images.simulated[0].data()[i] +
                            bse * images.simulated[1].data()[i] + offset +
                            (noise > 0 ? noise * normal(random) : 0);
}

TEST(Calibrate, RecoversKnownGains) {
  CalibrationImages images = two_channels(40, 30, 0.6);
  expose(images, 120, 310, -14, 0, 1);
  const Calibration c = calibrate(images);
  EXPECT_EQ(c.outcome, CalibrationOutcome::trusted);
  EXPECT_THAT(c.warnings, IsEmpty());
  EXPECT_NEAR(c.gains[0], 120, 1e-9);
  EXPECT_NEAR(c.gains[1], 310, 1e-9);
  EXPECT_NEAR(c.offset, -14, 1e-9);
  EXPECT_NEAR(c.residual_rms, 0, 1e-9);
  EXPECT_NEAR(c.explained, 1, 1e-12);
  EXPECT_NEAR(c.condition_number, std::sqrt(1.6 / 0.4), 0.25);
  EXPECT_EQ(c.pixels, 1200);
}

TEST(Calibrate, StandardErrorsCoverTheTruth) {
  CalibrationImages images = two_channels(24, 20, 0.9);
  constexpr int draws = 1000;
  const double truth[] = {120, 310, -14};
  int covered[3] = {};
  test::Sample rms, across;
  for (int draw = 0; draw < draws; ++draw) {
    expose(images, truth[0], truth[1], truth[2], 6, static_cast<std::uint64_t>(draw + 1));
    const Calibration c = calibrate(images);
    const double value[] = {c.gains[0], c.gains[1], c.offset};
    const double error[] = {c.gain_stderr(0), c.gain_stderr(1), c.offset_stderr()};
    for (int i = 0; i < 3; ++i) covered[i] += std::fabs(value[i] - truth[i]) < 1.9650 * error[i];
    rms.add(c.residual_rms * std::sqrt(480.0 / 477));
    across.add((c.gains[0] - truth[0]) * (c.gains[1] - truth[1]) - c.covariance[1]);
  }
  // Student's t with 477 degrees: 95 % within 1.9650 standard errors.
  const double scatter = std::sqrt(draws * 0.95 * 0.05);
  for (const int n : covered) EXPECT_NEAR(n, 0.95 * draws, test::z_limit(5) * scatter);
  test::expect_mean(rms.mean(), rms.standard_error(), 6, 5, 6.0 / (4 * 477));
  test::expect_mean(across.mean(), across.standard_error(), 0, 5);
}

TEST(Calibrate, TheOffsetOfACentredChannelIsAMean) {
  CalibrationImages images = two_channels(20, 20, 0.5);
  images.channels = {"SE"};
  images.simulated.resize(1);
  for (std::size_t i = 0; i < 400; ++i) images.simulated[0].data()[i] = i % 2 ? 1 : -1;
  RandomStream random(4, 0, 0);
  for (double& e : images.real.data()) e = normal(random);
  const Calibration c = calibrate(images);
  EXPECT_NEAR(c.offset_stderr(), c.residual_rms * std::sqrt(400.0 / 398) / 20, 1e-12);
  EXPECT_NEAR(c.gain_stderr(0), c.offset_stderr(), 1e-12);
}

TEST(Calibrate, WeightsCountNoisyPixelsLess) {
  CalibrationImages images = two_channels(40, 40, 0.3);
  expose(images, 100, 200, 5, 1, 3);
  images.weights = Grid<double>(40, 40, 1);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      images.real(x, y) += x % 2 ? 300 : -300, images.weights(x, y) = 1e-8;
  const Calibration c = calibrate(images);
  test::expect_mean(c.gains[0], c.gain_stderr(0), 100, 3);
  test::expect_mean(c.gains[1], c.gain_stderr(1), 200, 3);
  images.weights = {};
  EXPECT_GT(calibrate(images).gain_stderr(0), 20 * c.gain_stderr(0));
}

TEST(Calibrate, LeavesOutWhatIsMaskedNotFiniteOrSaturated) {
  CalibrationImages images = two_channels(30, 30, 0.3);
  expose(images, 100, 200, 5, 0, 3);
  images.used = Mask(30, 30, 1);
  images.used(3, 4) = 0, images.real(3, 4) = 1e6;
  images.real(5, 6) = NAN;
  images.simulated[1](7, 8) = std::numeric_limits<double>::infinity();
  images.real(9, 9) = 255, images.real(9, 10) = 300, images.real(11, 11) = -1;
  const Calibration c = calibrate(images, {.black = 0, .white = 255});
  EXPECT_EQ(c.pixels, 900 - 6);
  EXPECT_EQ(c.saturated, 3);
  EXPECT_NEAR(c.gains[0], 100, 1e-9);
  EXPECT_NEAR(c.offset, 5, 1e-9);
}

TEST(Calibrate, KeepsAKnownOffset) {
  CalibrationImages images = two_channels(30, 30, 0.3);
  expose(images, 100, 200, 5, 0.5, 3);
  const Calibration c = calibrate(images, {.offset = 5});
  EXPECT_EQ(c.offset, 5);
  EXPECT_EQ(c.offset_stderr(), 0);
  test::expect_mean(c.gains[0], c.gain_stderr(0), 100, 2);
  test::expect_mean(c.gains[1], c.gain_stderr(1), 200, 2);
}

TEST(Calibrate, FitsOneGainOfAKnownRatio) {
  CalibrationImages images = two_channels(30, 30, 1);
  expose(images, 100, 250, 5, 0.5, 3);
  const Calibration c = calibrate(images, {.ratios = {1, 2.5}});
  EXPECT_EQ(c.outcome, CalibrationOutcome::trusted);
  EXPECT_EQ(c.condition_number, 1);
  test::expect_mean(c.gains[0], c.gain_stderr(0), 100);
  EXPECT_DOUBLE_EQ(c.gains[1], 2.5 * c.gains[0]);
  EXPECT_DOUBLE_EQ(c.gain_stderr(1), 2.5 * c.gain_stderr(0));
}

TEST(Calibrate, WarnsWhereChannelsAreNearlyProportional) {
  CalibrationImages images = two_channels(30, 30, 0.9995);
  expose(images, 100, 200, 5, 0, 3);
  const Calibration c = calibrate(images);
  EXPECT_EQ(c.outcome, CalibrationOutcome::doubtful);
  EXPECT_GT(c.condition_number, 30);
  ASSERT_EQ(c.warnings.size(), 1u);
  EXPECT_THAT(c.warnings[0], HasSubstr("SE and BSE have a correlation of 0.999"));
  EXPECT_THAT(c.warnings[0], HasSubstr("fix the ratio"));
}

TEST(Calibrate, ProportionalChannelsLeaveTheGainsOpen) {
  for (const bool fixed : {false, true}) {
    CalibrationImages images = two_channels(30, 30, 0.5);
    for (std::size_t i = 0; i < images.real.size();
         ++i)  // as it comes out of a file of 32-bit floats
      images.simulated[1].data()[i] =
          static_cast<float>(0.3 * images.simulated[0].data()[i] + (fixed ? 0 : 0.1));
    expose(images, 100, 200, 5, 0, 3);
    const Calibration c =
        calibrate(images, {.offset = fixed ? std::optional<double>(5) : std::nullopt});
    EXPECT_EQ(c.outcome, CalibrationOutcome::undetermined);
    EXPECT_TRUE(std::isinf(c.condition_number));
    EXPECT_TRUE(std::isinf(c.gain_stderr(0)));
    ASSERT_FALSE(c.warnings.empty());
    EXPECT_THAT(c.warnings[0], HasSubstr("cannot be told apart"));
    EXPECT_LT(c.residual_rms, 1e-4) << "the smallest gains fit as well as any";
    EXPECT_NEAR(c.gains[0] + 0.3 * c.gains[1], 160, 1e-3);
  }
}

TEST(Calibrate, AFlatSurfaceLeavesTheOffsetOpen) {
  CalibrationImages images = two_channels(10, 10, 0.5);
  images.channels = {"SE"};
  images.simulated = {Grid<double>(10, 10, 0.7)};
  images.real = Grid<double>(10, 10, 90);
  const Calibration c = calibrate(images);
  EXPECT_EQ(c.outcome, CalibrationOutcome::undetermined);
  EXPECT_THAT(c.warnings.at(0), HasSubstr("does not vary"));
  EXPECT_NEAR(calibrated_image(c, images.simulated)(3, 3), 90, 1e-9);
}

TEST(Calibrate, WarnsOfNegativeAndOfVagueGains) {
  CalibrationImages images = two_channels(30, 30, 0.2);
  expose(images, 100, -200, 5, 0.5, 3);
  Calibration c = calibrate(images);
  EXPECT_EQ(c.outcome, CalibrationOutcome::doubtful);
  EXPECT_THAT(c.warnings.at(0), HasSubstr("the gain of BSE is below 0"));
  // A detector may not see a channel: that is said, and the other one's gain stands.
  expose(images, 100, 0, 5, 3, 3);
  c = calibrate(images);
  EXPECT_EQ(c.outcome, CalibrationOutcome::trusted);
  EXPECT_THAT(c.warnings.at(0), HasSubstr("it may be 0"));
  // An image that shows none of them.
  expose(images, 0.01, 0.01, 5, 3, 3);
  EXPECT_EQ(calibrate(images).outcome, CalibrationOutcome::doubtful);
}

TEST(Calibrate, WarnsOfPilesButNotOfFlatGround) {
  CalibrationImages images = two_channels(60, 60, 0.2);
  expose(images, 100, 200, 5, 0, 3);
  for (double& e : images.real.data()) e = std::min(e, 160.0);
  const Calibration c = calibrate(images);
  ASSERT_EQ(c.warnings.size(), 1u);
  EXPECT_THAT(c.warnings[0], HasSubstr("leave them out by --white 160"));
  CalibrationImages ground = two_channels(60, 60, 0.2);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 60; ++x) ground.simulated[0](x, y) = 0.1, ground.simulated[1](x, y) = 0.05;
  expose(ground, 100, 200, 5, 0, 3);
  EXPECT_THAT(calibrate(ground).warnings, IsEmpty());
}

TEST(Calibrate, SaysWhereResidualsHaveStructure) {
  CalibrationImages images = two_channels(40, 40, 0.2);
  expose(images, 100, 200, 5, 0.1, 3);
  EXPECT_NEAR(calibrate(images).residual_correlation, 0, 0.15);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) images.real(x, y) += 3 * std::sin(0.2 * x);
  const Calibration c = calibrate(images);
  EXPECT_GT(c.residual_correlation, 0.9);
  EXPECT_THAT(c.warnings.at(0), HasSubstr("standard errors"));
  EXPECT_EQ(c.outcome, CalibrationOutcome::trusted);
}

TEST(Calibrate, RefusesWhatDoesNotFit) {
  CalibrationImages images = two_channels(6, 5, 0.2);
  expose(images, 100, 200, 5, 0.1, 3);
  CalibrationImages wrong = images;
  wrong.simulated[1] = Grid<double>(5, 6);
  EXPECT_THROW(calibrate(wrong), InvalidInput);
  wrong = images;
  wrong.simulated[1] = Grid<double>(6, 5);
  EXPECT_THROW(calibrate(wrong), InvalidInput) << "all 0";
  wrong = images;
  wrong.real = Grid<double>(6, 5, NAN);
  EXPECT_THROW(calibrate(wrong), InvalidInput);
  wrong = images;
  wrong.weights = Grid<double>(6, 5, -1);
  EXPECT_THROW(calibrate(wrong), InvalidInput);
  EXPECT_THROW(calibrate(images, {.ratios = {1}}), UsageError);
  EXPECT_THROW(calibrate(images, {.black = 3, .white = 3}), UsageError);
  EXPECT_THROW(calibrate(images, {.offset = NAN}), UsageError);
}

TEST(FoldCalibration, GivesTheCalibratedFilterBank) {
  const FilterBankParameters bank{
      {{5, 0.6}, {7, 0.9}},
      false,
      {{"SE", 0.9, {1, 2}, {3, 4}, {5, 6}}, {"BSE", 0.2, {-1, 0}, {0, 1}, {2, 3}}}};
  Calibration c;
  c.channels = {"BSE", "SE"};
  c.gains = {10, 100};
  c.offset = -7;
  const FilterBankParameters folded = fold(c, bank, "L");
  ASSERT_EQ(folded.channels.size(), 1u);
  EXPECT_EQ(folded.channels[0].name, "L");
  EXPECT_NEAR(folded.channels[0].offset, 90 + 2 - 7, 1e-12);
  EXPECT_EQ(folded.channels[0].slope, (std::vector<double>{90, 200}));
  EXPECT_EQ(folded.channels[0].max_curvature, (std::vector<double>{300, 410}));
  EXPECT_EQ(folded.channels[0].min_curvature, (std::vector<double>{520, 630}));
  c.channels[0] = "TE";
  EXPECT_THROW(fold(c, bank), InvalidInput);
}

}  // namespace
}  // namespace surf
