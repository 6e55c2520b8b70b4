// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/units.h"
#include "surf/mc/results/result_summary.h"
#include "surf/mc/sampling/expected_primaries.h"

namespace surf::workflow {
namespace {

// 1000 pixels of 100 primaries each, 40 of which count, simulated in a second.
mc::SimulationResult coarse() {
  mc::SimulationResult r;
  r.detectors = {mc::default_detectors()[0]};
  r.pixels = LargeGrid<mc::PixelTally>(100, 10);
  r.counts.emplace_back(100, 10);
  r.controls.emplace_back(100, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 100; ++x) {
      r.pixels(x, y) = {100, 100, mc::PixelModel::replay};
      r.counts[0](x, y) = {40, 40};
    }
  r.balance.incident = 100'000;
  r.budget = mc::Accuracy{coarse_accuracy, 0.0001};
  r.library_cascades = 10'240;
  r.library_seconds = 2;
  r.seconds = 1;
  return r;
}

TimeBudget seconds(double left) { return {left, 1, 1e9, 10'240}; }

TEST(TimeBudget, FourTimesTheTimeIsTwiceTheAccuracy) {
  const double at_100 = accuracy_that_fits(coarse(), seconds(100));
  const double at_400 = accuracy_that_fits(coarse(), seconds(400));
  EXPECT_NEAR(at_100 / at_400, 2, 0.2);
}

TEST(TimeBudget, KeepsToTheTime) {
  const auto r = coarse();
  for (const double left : {10.0, 30.0, 100.0, 1000.0}) {
    const double accuracy = accuracy_that_fits(r, seconds(left));
    mc::SimulationOptions options;
    options.budget = mc::Accuracy{accuracy};
    const double cascades = double(mc::library_size(options, 1)) - 10'240;
    const double time = mc::expected_primaries(r, accuracy) * 1e-5 + cascades * 2 / 10'240;
    EXPECT_LE(time, 0.9 * left) << left;
    EXPECT_GE(time, 0.6 * left) << left;  // two digits lose no more
  }
}

TEST(TimeBudget, HasTwoDigits) {
  for (const double left : {10.0, 33.0, 77.0, 500.0}) {
    const double accuracy = accuracy_that_fits(coarse(), seconds(left));
    EXPECT_LE(format_share(accuracy).size(), std::string("0.13 %").size())
        << format_share(accuracy);
    EXPECT_EQ(parse_share(format_share(accuracy), "test"), accuracy);
  }
}

TEST(TimeBudget, StaysCoarseWithoutTimeOrMemory) {
  EXPECT_EQ(accuracy_that_fits(coarse(), seconds(0)), coarse_accuracy);
  EXPECT_EQ(accuracy_that_fits(coarse(), seconds(-3)), coarse_accuracy);
  TimeBudget narrow = seconds(1000);
  narrow.most_library_cascades = 12'000;  // 4 / 12000 = 0.0183^2
  EXPECT_NEAR(accuracy_that_fits(coarse(), narrow), 0.0183, 0.003);
}

TEST(TimeBudget, PlanesTakeTime) {
  auto planes = coarse();
  for (int x = 0; x < 100; ++x) {
    planes.pixels(x, 0).model = mc::PixelModel::difference;
    planes.controls[0](x, 0) = {0.001 * x, 0, 1};
  }
  EXPECT_GT(accuracy_that_fits(planes, seconds(5)), 0);
  EXPECT_EQ(mc::planes_used(planes), 100u);
  planes.seconds = coarse().seconds * (1e5 + 100 * 10'240.0) / 1e5;  // as long for each primary
  EXPECT_GT(accuracy_that_fits(planes, seconds(100)), accuracy_that_fits(coarse(), seconds(100)));
}

}  // namespace
}  // namespace surf::workflow
