// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

constexpr double sigma_nm = 0.1;

HeightField noisy_scan(const Tip& tip, bool lines) {
  constexpr int pixels = 96;
  HeightField f;
  f.z_nm = Grid<double>(pixels, pixels);
  RandomStream random(4, 0, 0);
  for (int k = 0; k < 150; ++k) {
    const int x = static_cast<int>(random.uniform() * pixels),
              y = static_cast<int>(random.uniform() * pixels);
    if (!lines) f.z_nm(x, y) = 2 + 10 * random.uniform();
  }
  for (int y = 0; lines && y < pixels; ++y)
    for (int x = 10; x < pixels; x += 20) f.z_nm(x, y) = 8;
  f = dilate(f, tip);
  const Grid<double> e = simulate_noise({0, sigma_nm * sigma_nm}, pixels, pixels, 7);
  for (std::size_t k = 0; k < e.size(); ++k) f.z_nm.data()[k] += e.data()[k];
  return f;
}

TipSweepOptions options() {
  TipSweepOptions o;
  o.blind.width = o.blind.height = 13;
  o.noise = {0, sigma_nm * sigma_nm};
  o.thresholds = 24;
  return o;
}

Tip truth() { return parabolic_tip(4, {1, 1, 13, 13}); }

double rms_error(const Tip& estimate, const Tip& true_tip, double depth_nm) {
  double squares = 0, n = 0;
  for (std::size_t k = 0; k < true_tip.z_nm.size(); ++k) {
    if (true_tip.z_nm.data()[k] < -depth_nm) continue;
    squares += std::pow(estimate.z_nm.data()[k] - true_tip.z_nm.data()[k], 2);
    n += 1;
  }
  return std::sqrt(squares / n);
}

TEST(TipSweep, FindsAThresholdWhoseTipIsAmongTheBest) {
  const TipSweep sweep = sweep_tips({noisy_scan(truth(), false)}, options());
  ASSERT_EQ(sweep.curve.size(), 24u);
  EXPECT_EQ(sweep.verdict, TipSweepVerdict::clear);
  double best = HUGE_VAL;
  for (std::size_t k = 0; k < sweep.curve.size(); ++k) {
    const SweptTip& t = sweep.curve[k];
    if (k > 0) {
      EXPECT_GT(t.threshold_nm, sweep.curve[k - 1].threshold_nm);
      EXPECT_GE(t.volume_nm3, 0.9 * sweep.curve[k - 1].volume_nm3);  // thresholds blunt
    }
    best = std::min(best, rms_error(t.tip, truth(), 5));
  }
  const SweptTip& chosen = sweep.curve[sweep.chosen];
  EXPECT_TRUE(chosen.consistent);
  EXPECT_LE(rms_error(chosen.tip, truth(), 5), 1.5 * best);
  EXPECT_GT(rms_error(sweep.curve.front().tip, truth(), 5), 3 * best);   // too sharp
  EXPECT_GT(rms_error(sweep.curve.back().tip, truth(), 5), 1.5 * best);  // too blunt
}

TEST(TipSweep, TheWorseOfAllAndOfTheLargestResidualsDecides) {
  SweptTip t;
  EXPECT_EQ(t.excess(), 0) << "nothing is left";
  t.residual_nm = 1, t.peaks_nm = 6, t.expected_peaks_nm = 2;
  EXPECT_EQ(t.excess(), HUGE_VAL) << "and nothing was expected";
  t.expected_nm = 1;
  EXPECT_EQ(t.excess(), 3);
  t.expected_nm = 0.25;
  EXPECT_EQ(t.excess(), 4);
}

// Sharp tips made of noise leave the noise in the opening: little is expected to be lacking, and
// little is.
TEST(TipSweep, TipsThatLeaveTheNoiseInDoNotCount) {
  HeightField flat;
  flat.z_nm = simulate_noise({0, sigma_nm * sigma_nm}, 96, 96, 7);
  const TipSweep sweep = sweep_tips({flat}, options());
  double most_expected = 0, least_excess = HUGE_VAL;
  for (const SweptTip& t : sweep.curve) most_expected = std::max(most_expected, t.expected_nm);
  int left_out = 0;
  for (const SweptTip& t : sweep.curve) {
    const bool smooths = t.expected_nm >= 0.6 * most_expected;
    if (smooths) least_excess = std::min(least_excess, t.excess());
    EXPECT_TRUE(smooths || !t.consistent) << t.threshold_nm;
  }
  for (const SweptTip& t : sweep.curve)
    left_out +=
        t.expected_nm < 0.6 * most_expected && t.excess() <= 1.1 * std::max(1.0, least_excess);
  EXPECT_GT(left_out, 0) << "else this scan does not show it";
}

TEST(TipSweep, DoesNotDependOnThreads) {
  TipSweepOptions o = options();
  o.thresholds = 4;
  o.blind.threads = 1;
  const TipSweep one = sweep_tips({noisy_scan(truth(), false)}, o);
  o.blind.threads = 3;
  const TipSweep three = sweep_tips({noisy_scan(truth(), false)}, o);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_TRUE(one.curve[k].tip.z_nm == three.curve[k].tip.z_nm);
    EXPECT_EQ(one.curve[k].residual_nm, three.curve[k].residual_nm);
  }
}

TEST(TipSweep, RefusesImpossibleOptionsAndStops) {
  const HeightField scan = noisy_scan(truth(), false);
  for (int wrong = 0; wrong < 4; ++wrong) {
    TipSweepOptions o = options();
    if (wrong == 0) o.thresholds = 1;
    if (wrong == 1) o.least_nm = 2, o.most_nm = 1;
    if (wrong == 2) o.draws = 1;
    if (wrong == 3) o.tolerance_per_threshold = -1;
    EXPECT_THROW(sweep_tips({scan}, o), UsageError) << wrong;
  }
  CancelToken cancel;
  cancel.cancel();
  TipSweepOptions stopped = options();
  stopped.watch.cancel = &cancel;
  EXPECT_THROW(sweep_tips({scan}, stopped), Interrupted);
}

TEST(UnconstrainedDirections, AreThoseAlongParallelLines) {
  const TipSweep lines = sweep_tips({noisy_scan(truth(), true)}, options());
  const std::vector<double> along = unconstrained_directions(lines.curve[lines.chosen].tip, 1);
  ASSERT_FALSE(along.empty());
  for (const double degrees : along)
    EXPECT_LT(std::fabs(std::cos(degrees * 3.14159265358979324 / 180)), 0.8)
        << degrees;  // about +y or -y
  const TipSweep spikes = sweep_tips({noisy_scan(truth(), false)}, options());
  EXPECT_TRUE(unconstrained_directions(spikes.curve[spikes.chosen].tip, 1).empty());
}

TEST(OuterThreshold, GrowsWithTheScanAndTheNoise) {
  const AfmNoise noise{0, 1};
  EXPECT_GT(outer_threshold_nm(noise, 1e6, 100), outer_threshold_nm(noise, 1e4, 100));
  EXPECT_NEAR(outer_threshold_nm({0, 4}, 1e4, 100), 2 * outer_threshold_nm(noise, 1e4, 100), 1e-9);
  EXPECT_NEAR(outer_threshold_nm(noise, 1, 1), 1.6449 * std::sqrt(2), 1e-3);  // one pair at 95 %
}

}  // namespace
}  // namespace surf
