// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/results/result_summary.h"
#include "surf/mc/sampling/expected_primaries.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf::mc {
namespace {

// Four pixels: beside the specimen, a plane, a difference to it and replay alone; each of the
// latter with 100 primaries of which 40 count one (or differ by one).
SimulationResult result_of_every_kind() {
  SimulationResult r;
  r.detectors = {default_detectors()[0]};
  r.pixels = LargeGrid<PixelTally>(4, 1);
  r.counts.emplace_back(4, 1);
  r.controls.emplace_back(4, 1);
  r.budget = Accuracy{0.1, 0.002};
  r.library_cascades = 10000;
  const PixelModel models[] = {PixelModel::none, PixelModel::plane, PixelModel::difference,
                               PixelModel::replay};
  for (int x = 1; x < 4; ++x) {
    const std::int64_t n = x == 1 ? 0 : 100;
    r.pixels(x, 0) = {n, x == 1 ? 1 : n, models[x]};
    if (x > 1) r.counts[0](x, 0) = {40, 40};
    if (x < 3) r.controls[0](x, 0) = {1, 0.01, x == 1 ? 0 : 0.5};
  }
  return r;
}

const double own_error = std::sqrt(0.4 * 0.6 / 99);

TEST(ResultSummary, CountsPixelsAndElectrons) {
  const ResultSummary s = summarize(result_of_every_kind());
  EXPECT_EQ(s.pixels, 4);
  EXPECT_EQ(s.seen, 3);
  EXPECT_EQ(s.models, (std::array<std::int64_t, pixel_models>{1, 0, 1, 1, 1}));
  EXPECT_EQ(s.fewest_electrons, 0);
  EXPECT_EQ(s.most_electrons, 100);
  EXPECT_NEAR(s.mean_electrons, 200.0 / 3, 1e-12);
}

TEST(ResultSummary, ErrorsOfLibrariesAddUp) {
  const SimulationResult r = result_of_every_kind();
  const Estimate e = summarize(r).yields[0];
  EXPECT_NEAR(e.mean, (1 + 1.4 + 0.4) / 3, 1e-12);
  // Independent parts of two pixels; the library's parts of three, a hundredth of the variance each
  // where 100 of 10000 cascades are drawn, with that of the plane where there is one.
  const double difference = r.yield(0, 2, 0).standard_error;
  const double common[] = {0.01, std::hypot(0.01, 0.1 * difference), 0.1 * own_error};
  const double variance = difference * difference - common[1] * common[1] + own_error * own_error -
                          common[2] * common[2];
  EXPECT_NEAR(e.standard_error,
              std::hypot(std::sqrt(variance), common[0] + common[1] + common[2]) / 3, 1e-12);
}

TEST(ResultSummary, FindsPixelsThatMissedTheAccuracy) {
  SimulationResult r = result_of_every_kind();
  ResultSummary s = summarize(r);  // asked for: 0.1, 0.14, 0.04; only the last is not reached
  EXPECT_EQ(s.missed, 1);
  EXPECT_NEAR(s.worst, own_error / 0.04, 1e-12);
  r.budget = Accuracy{0.2, 0.002};
  EXPECT_EQ(summarize(r).missed, 0);
  r.budget = Accuracy{0.01, 0.002};
  EXPECT_EQ(summarize(r).missed, 2);  // the plane: 0.01 of 0.01
}

TEST(ResultSummary, NobodySeesNothing) {
  SimulationResult r = result_of_every_kind();
  r.pixels = LargeGrid<PixelTally>(4, 1);
  const ResultSummary s = summarize(r);
  EXPECT_EQ(s.seen, 0);
  EXPECT_EQ(s.models[0], 4);
  EXPECT_EQ(s.fewest_electrons, 0);
  EXPECT_EQ(s.yields[0].mean, 0);
}

TEST(ResultSummary, TellsWhatAnAccuracyTakes) {
  const SimulationResult r = result_of_every_kind();
  // Variances of 0.24 (100/99) and means of 1.4 and 0.4; pilots of 24, a reserve of a tenth.
  const auto wanted = [](double target) { return 24 + 1.1 * 0.24 * 100 / 99 / (target * target); };
  EXPECT_NEAR(expected_primaries(r, 0.01), wanted(0.014) + wanted(0.004), 1e-6);
  EXPECT_NEAR(expected_primaries(r, 1), 2 * (24 + 1.1 * 32), 1e-9);
  EXPECT_EQ(planes_used(r), 1u);
}

}  // namespace
}  // namespace surf::mc
