// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine_agreement.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf::workflow {
namespace {

// What a bent relation between yields explains stays unexplained by gain and offset alone.
TEST(UnexplainedShare, MayBeLessWhatTheStateSaysThatSimulationsAreOffBy) {
  RefinedView view;
  view.placement.pitch_x_nm = view.placement.pitch_y_nm = 4;
  view.simulated = Grid<double>(30, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x)
      view.simulated(x, y) = 1 + 0.4 * std::sin(0.5 * x) * std::cos(0.35 * y) + 0.02 * x;
  view.first_half = view.second_half = view.simulated;
  view.measured = view.simulated;
  RefinedViewState state{500, 40};
  state.bend = 0.2;
  const Grid<double> error = simulation_error(view, state, view.simulated);
  for (std::size_t p = 0; p < error.size(); ++p)
    view.measured.data()[p] = 500 * view.simulated.data()[p] + 40 + error.data()[p];
  const SemNoise none{0, 0};
  const double by_gain = unexplained_share(view, state, none, {}),
               by_all = unexplained_share(view, state, none, {}, true);
  EXPECT_GT(by_gain, 0.2);  // bend times the rms of squares, over the deviation: above 1 each
  EXPECT_NEAR(by_all, 0, 1e-9);
}

}  // namespace
}  // namespace surf::workflow
