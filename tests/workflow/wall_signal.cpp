// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_signal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/io/sim/materials.h"
#include "surf/workflow/libraries.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

TEST(WallSignal, ASpotAsASumOverPlacesIsTheOneThatElectronsAreDrawnFrom) {
  const test::TemporaryFolder folder;
  CachedLibraries libraries(folder.path());
  const FeatureShape edge{FeatureKind::edge, 100, 0, {30, 84, 2, 2}};
  WallSimulation drawn{io::find_material("Si", "test"), {}, 300, 4};
  drawn.first_u_nm = -20, drawn.step_nm = 5, drawn.places = 9;
  drawn.electrons = 20'000;
  WallSimulation summed = drawn, sharp = drawn;
  summed.step_nm = 2.5, summed.places = 17, summed.seed = 2;
  sharp.spot_nm = 0, sharp.seed = 3;
  ASSERT_EQ(blurred_by_nm(drawn), 0);
  ASSERT_NEAR(blurred_by_nm(summed), std::sqrt(16 - 1.25 * 1.25), 1e-12);
  const WallSignal by_draws = simulate_wall(edge, drawn, libraries),
                   by_sums = simulate_wall(edge, summed, libraries),
                   without = simulate_wall(edge, sharp, libraries);
  ASSERT_EQ(by_sums.mean.size(), 17u);
  const auto squares = [&](const WallSignal& other, std::size_t every) {
    double sum = 0;
    for (std::size_t k = 0; k < by_draws.mean.size(); ++k)
      sum +=
          std::pow(by_draws.mean[k] - other.mean[every * k], 2) /
          (std::pow(by_draws.standard_error[k], 2) + std::pow(other.standard_error[every * k], 2));
    return sum;
  };
  EXPECT_LT(squares(by_sums, 2), 27.9);  // chi-squared of 9, exceeded once in a thousand times
  EXPECT_GT(squares(without, 1), 100);
  for (std::size_t k = 0; k < by_draws.mean.size(); ++k)
    EXPECT_LT(by_sums.standard_error[2 * k], 0.6 * by_draws.standard_error[k]);
}

// Its signal jumps: at places without extent it would stay where it is, then move by a whole place.
TEST(WallSignal, TheEdgeOfAWallThatTheBeamDoesNotSeeMovesWithIt) {
  const test::TemporaryFolder folder;
  CachedLibraries libraries(folder.path());
  WallSimulation how{io::find_material("Si", "test"), {}, 300, 2};
  how.tilt_deg = 15, how.azimuth_deg = 180;
  how.first_u_nm = -25, how.step_nm = 1.6, how.places = 30;
  how.electrons = 300;
  constexpr int shapes = 12;
  constexpr double more_nm = 1.5;
  std::vector<double> edges;
  for (int i = 0; i < shapes; ++i) {
    const FeatureShape edge{FeatureKind::edge, 100, 0, {60 + more_nm * i, 88, 1, 1}};
    const WallSignal signal = simulate_wall(edge, how, libraries);
    const auto peak = std::ranges::max_element(signal.mean);
    const double half = 0.5 * (signal.mean.front() + *peak);
    const auto after = std::ranges::find_if(signal.mean, [&](double v) { return v > half; });
    ASSERT_LT(after, peak + 1);
    ASSERT_GT(after, signal.mean.begin());
    const double share = (half - after[-1]) / (after[0] - after[-1]);
    edges.push_back(how.first_u_nm +
                    how.step_nm * (static_cast<double>(after - signal.mean.begin()) - 1 + share));
  }
  const double each = (edges.back() - edges.front()) / (shapes - 1);
  EXPECT_LT(each, -0.1);
  for (int i = 0; i < shapes; ++i)
    EXPECT_NEAR(edges[static_cast<std::size_t>(i)], edges[0] + each * i, 0.25) << i;
}

}  // namespace
}  // namespace surf::workflow
