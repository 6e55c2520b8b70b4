// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/blind_tip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

constexpr int radius = 5, size = 2 * radius + 1;

// Lopsided: shows every flip.
Tip lopsided() {
  Tip tip;
  tip.z_nm = Grid<double>(size, size);
  tip.apex_x = tip.apex_y = radius;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i)
      tip.z_nm(i + radius, j + radius) =
          -0.4 * std::hypot(i, j) - 0.1 * std::max(0, i) - 0.05 * std::max(0, -j) - 0.02 * i * i;
  return tip;
}

// Two peaks of nearly the same height, on the row of the apex.
Tip double_tip() {
  Tip tip = lopsided();
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) {
      double& z = tip.z_nm(i + radius, j + radius);
      z = std::min(0.0, std::max(-1.5 * std::hypot(i, j), -0.02 - 1.5 * std::hypot(i - 3, j)));
    }
  return tip;
}

HeightField spikes(int pixels, std::uint64_t seed, double highest_nm = 12) {
  HeightField f;
  f.z_nm = Grid<double>(pixels, pixels);
  RandomStream random(seed, 0, 0);
  for (int k = 0; k < pixels * pixels / 40; ++k) {
    const int x = static_cast<int>(random.uniform() * pixels),
              y = static_cast<int>(random.uniform() * pixels);
    f.z_nm(x, y) = highest_nm * random.uniform();
  }
  return f;
}

HeightField with_noise(HeightField f, double sigma_nm, std::uint64_t seed, double alpha = 0) {
  if (sigma_nm == 0) return f;
  const Grid<double> e = simulate_noise({alpha, sigma_nm * sigma_nm * (1 - alpha * alpha)},
                                        f.z_nm.width(), f.z_nm.height(), seed);
  for (std::size_t k = 0; k < e.size(); ++k) f.z_nm.data()[k] += e.data()[k];
  return f;
}

BlindTipOptions options(double threshold_nm, double tolerance_nm) {
  BlindTipOptions o;
  o.width = o.height = size;
  o.threshold_nm = threshold_nm;
  o.apex_tolerance_nm = tolerance_nm;
  o.threads = 1;
  return o;
}

Tip estimate(const HeightField& scan, const BlindTipOptions& o) {
  Tip tip = blind_tip({scan}, o).tip;
  validate(tip);
  return tip;
}

// The deepest that an estimate lies below the truth; 0 for an outer bound.
double sharper_by(const Tip& estimate, const Tip& truth) {
  double most = 0;
  for (std::size_t k = 0; k < truth.z_nm.size(); ++k)
    most = std::max(most, truth.z_nm.data()[k] - estimate.z_nm.data()[k]);
  return most;
}

TEST(BlindTip, BoundsTheTipFromOutsideAndReproducesTheScan) {
  for (const Tip& truth : {lopsided(), double_tip()})
    for (const bool border : {true, false}) {
      const HeightField scan = dilate(spikes(60, 3), truth);
      BlindTipOptions o = options(0, 0);
      o.border = border;
      const Tip tip = estimate(scan, o);
      EXPECT_LT(sharper_by(tip, truth), 1e-4);
      const HeightField opened = opening(scan, tip);
      for (int y = size; y < 60 - size; ++y)
        for (int x = size; x < 60 - size; ++x)
          EXPECT_NEAR(opened.z_nm(x, y), scan.z_nm(x, y), 1e-3);
    }
}

TEST(BlindTip, FindsATipThatSpikesShowWhole) {
  const Tip truth = lopsided();
  HeightField one;
  one.z_nm = Grid<double>(41, 41);
  one.z_nm(20, 20) = 30;
  const Tip tip = estimate(dilate(one, truth), options(0, 0));
  for (std::size_t k = 0; k < truth.z_nm.size(); ++k)
    EXPECT_NEAR(tip.z_nm.data()[k], truth.z_nm.data()[k], 1e-4);
}

TEST(BlindTip, IsTheSameForAnyThreadsAndScansTogetherTellMore) {
  const Tip truth = lopsided();
  const HeightField a = with_noise(dilate(spikes(60, 5), truth), 0.1, 1);
  const HeightField b = with_noise(dilate(spikes(60, 6), truth), 0.1, 2);
  BlindTipOptions o = options(0.5, 0.5);
  const Tip both = blind_tip({a, b}, o).tip;
  o.threads = 3;
  EXPECT_TRUE(blind_tip({a, b}, o).tip.z_nm == both.z_nm);
  EXPECT_TRUE(blind_tip({b, a}, o).tip.z_nm == both.z_nm);
  EXPECT_LT(sharper_by(estimate(a, options(0.5, 0.5)), both),
            1e-5);  // both together are no blunter
  o.start = estimate(a, options(0.5, 0.5));
  const Tip warm = blind_tip({a, b}, o).tip;
  for (std::size_t k = 0; k < both.z_nm.size(); ++k)
    EXPECT_NEAR(warm.z_nm.data()[k], both.z_nm.data()[k], 1e-3);
}

// The thesis's figure 4-5: noise takes the intersection of the two peaks for the tip.
TEST(BlindTip, IsOversharpenedWithoutApexTolerance) {
  const Tip truth = double_tip();
  int sharpened = 0, held = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const HeightField scan = with_noise(dilate(spikes(70, seed), truth), 0.05, seed);
    sharpened += sharper_by(estimate(scan, options(0.4, 0)), truth) > 0.5;
    held += sharper_by(estimate(scan, options(0.4, 0.4)), truth) == 0;
  }
  EXPECT_EQ(sharpened, 5);
  EXPECT_EQ(held, 5);
}

// From 0 to 6 standard deviations: too small a threshold breaks the tip, a large one bounds it.
TEST(BlindTip, BreaksBelowSomeStandardDeviationsOfThreshold) {
  const Tip truth = lopsided();
  constexpr double sigma = 0.1;
  const HeightField scan = with_noise(dilate(spikes(90, 2), truth), sigma, 4);
  std::vector<double> sharper;
  for (const double sigmas : {0.0, 1.0, 2.0, 3.0, 6.0})
    sharper.push_back(sharper_by(estimate(scan, options(sigmas * sigma, sigmas * sigma)), truth));
  EXPECT_GT(sharper[0], 1);
  EXPECT_GT(sharper[1], 0.5);
  EXPECT_EQ(sharper.back(), 0);
  for (std::size_t k = 1; k < sharper.size(); ++k) EXPECT_LE(sharper[k], sharper[k - 1] + sigma);
}

TEST(BlindTip, OuterThresholdBoundsTheTipInNearlyAllDraws) {
  const Tip truth = double_tip();
  constexpr double sigma = 0.1;
  constexpr int draws = 60;
  for (const double alpha : {0.0, 0.7}) {
    const AfmNoise noise{alpha, sigma * sigma * (1 - alpha * alpha)};
    const double threshold = outer_threshold_nm(noise, 50 * 50, size * size);
    EXPECT_GT(threshold, 3 * sigma);
    EXPECT_LT(threshold, 12 * sigma);
    int bounded = 0;
    for (std::uint64_t seed = 1; seed <= draws; ++seed)
      bounded +=
          sharper_by(estimate(with_noise(dilate(spikes(50, seed), truth), sigma, seed, alpha),
                              options(threshold, threshold)),
                     truth) == 0;
    EXPECT_GE(bounded,
              54);  // of 60 at 95 %: fewer have a probability of 3e-2 at most; all do, in fact
  }
}

TEST(BlindTip, ALayerIsAsGoodAsTwiceItsHeightOfThreshold) {
  const Tip truth = lopsided();
  const HeightField scan = with_noise(dilate(spikes(60, 8), truth), 0.1, 3);
  BlindTipOptions layered = options(0, 0);
  layered.layer_nm = 0.3;
  EXPECT_EQ(sharper_by(estimate(scan, layered), truth), 0);
  const Tip one = estimate(scan, layered), other = estimate(scan, options(0.6, 0.6));
  for (std::size_t k = 0; k < truth.z_nm.size(); ++k)
    EXPECT_NEAR(one.z_nm.data()[k], other.z_nm.data()[k], 1e-3);
}

// Row offsets are noise between rows only.
TEST(BlindTip, AThresholdOfItsOwnAcrossRowsToleratesRowOffsets) {
  const Tip truth = lopsided();
  HeightField scan = dilate(spikes(60, 9), truth);
  RandomStream random(1, 2, 3);
  for (int y = 0; y < 60; ++y) {
    const double offset = 0.6 * random.uniform();
    for (int x = 0; x < 60; ++x) scan.z_nm(x, y) += offset;
  }
  BlindTipOptions o = options(0.02, 0.7);
  EXPECT_GT(sharper_by(estimate(scan, o), truth), 0.1);
  o.threshold_y_nm = 4;  // directions near the row's get a share of it
  const Tip tip = estimate(scan, o);
  for (int i = 0; i < size; ++i) EXPECT_GE(tip.z_nm(i, radius), truth.z_nm(i, radius) - 0.03) << i;
  for (int j = 0; j < size; ++j) EXPECT_GE(tip.z_nm(radius, j), truth.z_nm(radius, j)) << j;
}

TEST(BlindTip, HolesAllowEverything) {
  const Tip truth = lopsided();
  HeightField scan = dilate(spikes(60, 11), truth);
  const Tip whole = estimate(scan, options(0, 0));
  scan.valid = Mask(60, 60, 1);
  RandomStream random(1, 1, 1);
  for (int k = 0; k < 300; ++k) {
    const int x = static_cast<int>(60 * random.uniform()),
              y = static_cast<int>(60 * random.uniform());
    scan.valid(x, y) = 0;
    scan.z_nm(x, y) = std::nan("");
  }
  const Tip tip = estimate(scan, options(0, 0));
  EXPECT_LT(sharper_by(tip, truth), 1e-4);
  EXPECT_LT(sharper_by(tip, whole), 1e-4);
}

// The corners of a block have five lower neighbours, the rim of a pit of one sample has one.
TEST(BlindTip, MaximaHaveTwoLowerNeighboursAtLeast) {
  HeightField block;
  block.z_nm = Grid<double>(40, 40);
  for (int y = 19; y <= 21; ++y)
    for (int x = 19; x <= 21; ++x) block.z_nm(x, y) = 5;
  BlindTipOptions o = options(0, 0);
  o.maxima_only = true;
  EXPECT_NEAR(estimate(block, o).z_nm(radius + 3, radius), -5, 1e-4);
  HeightField pit;
  pit.z_nm = Grid<double>(40, 40);
  pit.z_nm(20, 20) = -5;
  const Tip tip = estimate(pit, o);
  for (const double z : tip.z_nm.data()) EXPECT_EQ(z, 0);
}

TEST(BlindTip, WithoutTheBorderOnlyPointsCountWhoseTipLiesWithin) {
  const auto lowest = [](int x, bool border) {
    HeightField spike;
    spike.z_nm = Grid<double>(40, 40);
    spike.z_nm(x, 20) = 5;
    BlindTipOptions o = options(0, 0);
    o.border = border;
    const Tip tip = estimate(spike, o);
    return *std::min_element(tip.z_nm.data().begin(), tip.z_nm.data().end());
  };
  EXPECT_NEAR(lowest(20, true), -5, 1e-4);
  EXPECT_NEAR(lowest(20, false), -5, 1e-4);
  EXPECT_LT(lowest(2 * radius - 1, true), -4);
  EXPECT_EQ(lowest(2 * radius - 1, false), 0) << "the tip may have reached over the border";
}

TEST(BlindTip, RefusesWhatCannotBe) {
  const HeightField scan = dilate(spikes(30, 1), lopsided());
  BlindTipOptions o = options(0, 0);
  EXPECT_THROW(blind_tip({}, o), UsageError);
  o.width = 31;
  EXPECT_THROW(blind_tip({scan}, o), InvalidInput);
  o = options(-1, 0);
  EXPECT_THROW(blind_tip({scan}, o), UsageError);
  HeightField other = scan, nothing = scan;
  other.pitch_x_nm = 2;
  EXPECT_THROW(blind_tip({scan, other}, options(0, 0)), InvalidInput);
  nothing.valid = Mask(30, 30, 0);
  EXPECT_THROW(blind_tip({nothing}, options(0, 0)), InvalidInput);
  CancelToken cancel;
  cancel.cancel();
  o = options(0, 0);
  o.watch.cancel = &cancel;
  EXPECT_THROW(blind_tip({scan}, o), Interrupted);
}

}  // namespace
}  // namespace surf
