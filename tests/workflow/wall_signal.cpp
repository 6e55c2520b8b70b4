// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_signal.h"

#include <gtest/gtest.h>

#include <cmath>

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
  ASSERT_EQ(blurred_by_nm(summed), 4);
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

}  // namespace
}  // namespace surf::workflow
