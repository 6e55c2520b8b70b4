// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/sem/calibration.h"

namespace surf {
namespace {

Grid<double> rough(int width, int height, std::uint64_t seed) {
  Grid<double> g(width, height);
  RandomStream random(seed, 0, 0);
  for (double& v : g.data()) v = 0.5 + random.uniform();
  return g;
}

TEST(SlowGain, IsTheRatioOfMeansOverTheWindow) {
  const Grid<double> e = rough(13, 9, 1), s = rough(13, 9, 2);
  Mask used(13, 9, 1);
  used(4, 4) = used(0, 0) = 0;
  const SlowGain slow = slow_gain(e, s, 3, 2, used);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 13; ++x) {
      double above = 0, below = 0;
      for (int v = std::max(0, y - 2); v <= std::min(8, y + 2); ++v)
        for (int u = std::max(0, x - 3); u <= std::min(12, x + 3); ++u)
          if (used(u, v)) above += e(u, v), below += s(u, v);
      EXPECT_NEAR(slow.gain(x, y), above / below, 1e-12);
    }
  }
  EXPECT_EQ(slow.unknown, 0);
}

TEST(SlowGain, FollowsAGainThatVariesSlowly) {
  const Grid<double> s = rough(200, 120, 3);
  Grid<double> e = s;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 200; ++x) e(x, y) *= 50 + 0.1 * x;
  const SlowGain slow = slow_gain(e, s, 10, 10);
  for (int y = 10; y < 110; ++y)
    for (int x = 10; x < 190; ++x) EXPECT_NEAR(slow.gain(x, y), 50 + 0.1 * x, 0.2);
}

TEST(SlowGain, MarksWhereThereIsNothingToDivideBy) {
  Grid<double> e(40, 10, 3), s(40, 10, 2);
  for (int y = 0; y < 10; ++y)
    for (int x = 20; x < 40; ++x) s(x, y) = x < 30 ? 0 : NAN;
  const SlowGain slow = slow_gain(e, s, 2, 2);
  EXPECT_EQ(slow.known(21, 5), 1);
  EXPECT_EQ(slow.known(22, 5), 0) << "a signal of 0";
  EXPECT_EQ(slow.known(35, 5), 0) << "no pixel at all";
  EXPECT_EQ(slow.unknown, 18 * 10);
  for (const double f : slow.gain.data()) EXPECT_TRUE(std::isfinite(f));
  EXPECT_EQ(slow.gain(35, 5), 1);
}

TEST(SlowGain, MayReachBeyondTheImage) {
  const SlowGain slow = slow_gain(Grid<double>(4, 4, 6), Grid<double>(4, 4, 2), 1000, 0);
  for (const double f : slow.gain.data()) EXPECT_DOUBLE_EQ(f, 3);
}

TEST(SlowGain, RefusesWhatDoesNotFit) {
  EXPECT_THROW(slow_gain(Grid<double>(4, 4), Grid<double>(4, 5), 1, 1), InvalidInput);
  EXPECT_THROW(slow_gain(Grid<double>(4, 4), Grid<double>(4, 4), -1, 1), UsageError);
}

}  // namespace
}  // namespace surf
