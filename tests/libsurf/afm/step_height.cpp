// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/step_height.h"

#include <cmath>

#include "statistics.h"
#include "surf/afm/noise.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double height_nm = 12;

struct Scene {
  HeightField field;
  Mask first{60, 24, 0}, second{60, 24, 0};
};

Scene tilted_step(const AfmNoise& noise, std::uint64_t seed) {
  Scene s;
  s.field.z_nm = simulate_noise(noise, 60, 24, seed);
  s.field.pitch_x_nm = 2, s.field.pitch_y_nm = 3;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 60; ++x) {
      s.field.z_nm(x, y) +=
          1e4 + 0.2 * s.field.x_nm(x) - 0.1 * s.field.y_nm(y) + (x >= 30 ? height_nm : 0);
      if (x >= 5 && x < 25) s.first(x, y) = 1;
      if (x >= 35 && x < 55) s.second(x, y) = 1;
    }
  }
  return s;
}

TEST(MeasureStep, IsExactWithoutNoise) {
  const Scene s = tilted_step({0, 0}, 1);
  const StepHeight h = measure_step(s.field, s.first, s.second);
  EXPECT_NEAR(h.height_nm, height_nm, 1e-8);
  EXPECT_NEAR(h.slope_x, 0.2, 1e-9);
  EXPECT_NEAR(h.slope_y, -0.1, 1e-9);
  EXPECT_NEAR(h.stderr_nm, 0, 1e-8);
  EXPECT_EQ(h.samples, 2u * 20 * 24);
  EXPECT_NEAR(measure_step(s.field, s.second, s.first).height_nm, -height_nm, 1e-8);
}

TEST(MeasureStep, ScattersAsItsStandardErrorSaysUnderCorrelatedNoise) {
  for (const double alpha : {0.0, 0.8}) {
    constexpr int draws = 400;
    test::Sample step, squares;
    for (int i = 0; i < draws; ++i) {
      const Scene s = tilted_step({alpha, 0.04}, static_cast<std::uint64_t>(i + 1));
      const StepHeight h = measure_step(s.field, s.first, s.second);
      step.add(h.height_nm);
      squares.add(std::pow((h.height_nm - height_nm) / h.stderr_nm, 2));
    }
    test::expect_mean(step.mean(), step.standard_error(), height_nm, 4);
    test::expect_mean(squares.mean(), squares.standard_error(), 1, 4, 0.05);
  }
}

TEST(MeasureStep, LeavesOutHoles) {
  Scene s = tilted_step({0, 0}, 1);
  s.field.valid = Mask(60, 24, 1);
  for (int y = 0; y < 24; ++y) s.field.valid(10, y) = 0, s.field.z_nm(10, y) = NAN;
  EXPECT_NEAR(measure_step(s.field, s.first, s.second).height_nm, height_nm, 1e-8);
}

TEST(MeasureStep, RefusesRegionsThatTellNothing) {
  const Scene s = tilted_step({0, 1}, 1);
  const Mask none(60, 24, 0);
  Mask left(60, 24, 0), right(60, 24, 0);
  for (int y = 0; y < 24; ++y) left(3, y) = right(50, y) = 1;  // single columns: tilt or step?
  EXPECT_THROW(measure_step(s.field, s.first, none), InvalidInput);
  EXPECT_THROW(measure_step(s.field, none, s.second), InvalidInput);
  EXPECT_THROW(measure_step(s.field, s.first, s.first), InvalidInput);
  EXPECT_THROW(measure_step(s.field, left, right), InvalidInput);
  EXPECT_THROW(measure_step(s.field, s.first, Mask(3, 3, 1)), InvalidInput);
  EXPECT_THROW(measure_step(s.field, s.first, {}), InvalidInput);
}

}  // namespace
}  // namespace surf
