// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/find_changes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "changing_surface.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using test::blurred_noise;

MeasuredDifference noise(int size, std::uint64_t seed, double deviation = 0.5,
                         double alike_px = 0) {
  MeasuredDifference m;
  m.pitch_x_nm = m.pitch_y_nm = 2;
  m.difference = blurred_noise(size, size, alike_px, seed);
  for (double& d : m.difference.data()) d *= deviation;
  m.deviation = Grid<double>(size, size, deviation);
  return m;
}

void add(MeasuredDifference& m, int x0, int y0, int side, double height) {
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) m.difference(x, y) += height;
}

TEST(FindChanges, TellsPlaceHeightAndVolumeWithTheirErrors) {
  double squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MeasuredDifference m = noise(64, seed);
    add(m, 20, 30, 10, 2);
    const Changes found = find_changes(m);
    ASSERT_GE(found.places.size(), 1u) << seed;
    const ChangedPlace& p = found.places.front();
    EXPECT_NEAR(p.centre_nm.x, 49, 2) << seed;
    EXPECT_NEAR(p.centre_nm.y, 69, 2) << seed;
    EXPECT_NEAR(p.area_nm2, 400, 120) << seed;
    EXPECT_NEAR(p.volume, 800, 200) << seed;
    EXPECT_NEAR(p.volume_error / p.volume, p.mean_error / p.mean, 1e-9);
    EXPECT_GT(p.probability, 0.99);
    EXPECT_GT(p.largest, 2);
    EXPECT_EQ(found.place(25, 35), 1);
    EXPECT_EQ(found.place(5, 5), 0);
    EXPECT_GT(found.probability(25, 35), 0.95);
    const double z = (p.mean - 2) / p.mean_error;
    squares += z * z, ++count;
  }
  // The border of a place is estimated, too, which moves its mean by as much again.
  EXPECT_LT(squares / count, 9);
}

TEST(FindChanges, BothSignsAndSeveralSizesStrongestFirst) {
  MeasuredDifference m = noise(96, 3);
  add(m, 10, 10, 4, 5);
  add(m, 60, 50, 24, -0.6);
  const Changes found = find_changes(m);
  ASSERT_GE(found.places.size(), 2u);
  for (std::size_t k = 1; k < found.places.size(); ++k)
    EXPECT_GE(found.places[k - 1].score, found.places[k].score);
  EXPECT_GT(found.places[0].mean, 4);
  EXPECT_LT(found.places[1].mean, 0);
  EXPECT_NEAR(found.places[1].centre_nm.x, 143, 10);
}

TEST(FindChanges, ClearChangesHaveTheirShapeAndNoNeighbours) {
  MeasuredDifference m = noise(64, 4);
  add(m, 20, 20, 11, 50);
  const Changes found = find_changes(m);
  ASSERT_EQ(found.places.size(), 1u);
  EXPECT_EQ(found.places[0].samples, 121);
  EXPECT_NEAR(found.places[0].mean, 50, 0.3);
}

TEST(FindChanges, TooSmallDeviationsAreWidened) {
  MeasuredDifference m = noise(64, 5);
  for (double& d : m.deviation.data()) d /= 3;
  const Changes found = find_changes(m);
  EXPECT_NEAR(found.spread, 3, 0.3);
  EXPECT_NEAR(found.deviation(10, 10), 0.5, 0.05);
  EXPECT_TRUE(found.places.empty());
}

TEST(FindChanges, DeviationsAreEstimatedWhereNoneAreGiven) {
  MeasuredDifference m = noise(64, 6);
  m.deviation = {};
  add(m, 40, 40, 10, 2);
  const Changes found = find_changes(m);
  EXPECT_NEAR(found.estimated_deviation, 0.5, 0.05);
  EXPECT_EQ(found.places.size(), 1u);
}

TEST(FindChanges, WithoutNoiseTheSmallestChangeCounts) {
  MeasuredDifference m = noise(64, 7, 0);
  m.deviation = {};
  EXPECT_TRUE(find_changes(m).places.empty());
  add(m, 40, 40, 4, 1e-3);
  const Changes found = find_changes(m);
  ASSERT_EQ(found.places.size(), 1u);
  EXPECT_EQ(found.places[0].samples, 16);
}

TEST(FindChanges, HolesMayHoldAnything) {
  MeasuredDifference m = noise(64, 8);
  m.systematic = Grid<double>(64, 64, 0.01);
  m.valid = Mask(64, 64, 1);
  for (int y = 10; y < 30; ++y)
    for (int x = 10; x < 30; ++x) {
      m.valid(x, y) = 0;
      m.difference(x, y) = std::numeric_limits<double>::quiet_NaN();
      m.deviation(x, y) = m.systematic(x, y) = std::numeric_limits<double>::infinity();
    }
  const Changes found = find_changes(m);
  EXPECT_TRUE(found.places.empty());
  for (const double p : found.probability.data()) EXPECT_TRUE(p >= 0 && p < 1);
  for (const double d : found.deviation.data()) EXPECT_TRUE(std::isfinite(d));
  EXPECT_EQ(found.probability(20, 20), 0);
}

TEST(FindChanges, CommonErrorsAreNoChanges) {
  MeasuredDifference m = noise(64, 9);
  Grid<double> wall(64, 64);
  for (int y = 0; y < 64; ++y) wall(30, y) = 1;
  for (int y = 0; y < 64; ++y) m.difference(30, y) += 1.8;
  EXPECT_FALSE(find_changes(m).places.empty());
  m.common = {wall};
  EXPECT_TRUE(find_changes(m).places.empty());
}

TEST(FindChanges, DoesNotDependOnThreads) {
  MeasuredDifference m = noise(48, 10, 0.5, 1.5);
  m.systematic = Grid<double>(48, 48, 0.1);
  add(m, 20, 20, 8, 2);
  ChangeOptions options;
  options.simulations = 51;
  options.threads = 1;
  const Changes one = find_changes(m, options);
  options.threads = 3;
  const Changes three = find_changes(m, options);
  EXPECT_EQ(one.threshold, three.threshold);
  EXPECT_EQ(one.probability, three.probability);
  EXPECT_EQ(one.place, three.place);
}

TEST(FindChanges, BadInputIsRefused) {
  const MeasuredDifference good = noise(32, 1);
  const auto refused = [&](const auto& spoil) {
    MeasuredDifference m = good;
    spoil(m);
    EXPECT_THROW(find_changes(m), InvalidInput);
  };
  refused([](MeasuredDifference& m) { m.difference(1, 1) = std::nan(""); });
  refused([](MeasuredDifference& m) { m.deviation(1, 1) = -1; });
  refused([](MeasuredDifference& m) { m.deviation = Grid<double>(31, 32); });
  refused([](MeasuredDifference& m) { m.systematic = Grid<double>(32, 32, -1); });
  refused([](MeasuredDifference& m) { m.common = {Grid<double>(3, 3)}; });
  refused([](MeasuredDifference& m) { m.valid = Mask(32, 32, 0); });
  refused([](MeasuredDifference& m) { m.valid = Mask(3, 3, 1); });
  refused([](MeasuredDifference& m) { m.pitch_x_nm = 0; });
  for (const double share : {0.0, 0.0005, 0.6, std::nan("")})
    EXPECT_THROW(find_changes(good, {.false_alarms = share}), UsageError);
  EXPECT_THROW(find_changes(good, {.smallest_px = 0}), UsageError);
  EXPECT_THROW(find_changes(good, {.largest_nm = -1}), UsageError);
  EXPECT_THROW(find_changes(good, {.simulations = -1}), UsageError);
  EXPECT_THROW(find_changes(good, {.least_spread = 0}), UsageError);
  CancelToken token;
  token.cancel();
  EXPECT_THROW(find_changes(good, {.watch = {{}, &token}}), Interrupted);
}

}  // namespace
}  // namespace surf
