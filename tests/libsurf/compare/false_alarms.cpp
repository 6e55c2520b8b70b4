// SPDX-License-Identifier: GPL-3.0-or-later
// The rate of false alarms, and what is found, on made-up surfaces. Ramps and seeds of the
// benchmark chose the method (bench/bench_compare.cpp); rounded walls and these seeds judge it.
#include <gtest/gtest.h>

#include <cmath>

#include "changing_surface.h"
#include "surf/compare/align_surfaces.h"
#include "surf/compare/find_changes.h"
#include "surf/compare/surface_difference.h"

namespace surf {
namespace {

using test::ChangingSurface;
using test::measured;
using test::Measuring;
using test::WallShape;

constexpr double noise_nm = 0.3;

Changes changes_between(const ChangingSurface& was, const ChangingSurface& is, std::uint64_t seed,
                        int size, double alike_px) {
  RandomStream random(seed, 9, 9);
  Measuring first{size, size, 2, 0, 0, noise_nm, alike_px};
  first.seed = 10 * seed;
  Measuring second = first;
  second.seed += 1;
  second.x_nm = 6 * random.uniform() - 3, second.y_nm = 6 * random.uniform() - 3;
  second.lift_nm = 4, second.tilt_x = 0.01;
  const HeightField before = measured(was, first), after = measured(is, second);
  const SurfaceAlignment a = align_surfaces(before, after);
  if (!a.usable()) {
    ADD_FAILURE() << "seed " << seed << ": " << a.reason;
    return {};
  }
  const SurfaceDifference d = surface_difference(before, after, a);
  MeasuredDifference m;
  m.placement() = d.placement();
  m.difference = d.difference_nm, m.systematic = d.interpolation_nm, m.common = d.common_nm;
  m.valid = d.valid;
  m.deviation = Grid<double>(size, size, noise_nm * std::sqrt(2.0));
  ChangeOptions options;
  options.simulations = 99;
  options.least_spread = std::sqrt(0.5 * (1 + d.averaged_share * d.averaged_share));
  return find_changes(m, options);
}

int alarms_of(int pairs, int size, double alike_px, std::uint64_t from, double wall_nm = 3) {
  int alarms = 0;
  for (int i = 0; i < pairs; ++i) {
    const std::uint64_t seed = from + std::uint64_t(i);
    const ChangingSurface surface(seed, 2.0 * size, WallShape::rounded, wall_nm);
    alarms += !changes_between(surface, surface, seed, size, alike_px).places.empty();
  }
  return alarms;
}

// Bounds: a binomial number of 24 trials at 5 % is above 7 with a probability of 1e-5, of 200
// trials above 24 with 3e-5. Of 99 simulated fields the threshold is the fifth largest, which
// makes 5 % of it.

TEST(FalseAlarms, AreNoMoreThanAskedForAmongWallsAndSlopes) {
  EXPECT_LE(alarms_of(24, 48, 0, 5000), 7);
}

TEST(FalseAlarmsOfMany, AreNoMoreThanAskedForAmongWallsAndSlopes) {
  EXPECT_LE(alarms_of(200, 72, 0, 6000), 24);
}

TEST(FalseAlarmsOfMany, AreNoMoreThanAskedForWithCorrelatedNoise) {
  EXPECT_LE(alarms_of(200, 72, 1.5, 27000), 24);
}

TEST(FalseAlarmsOfMany, AreNoMoreThanAskedForAmongWallsNarrowerThanSamples) {
  EXPECT_LE(alarms_of(200, 72, 0, 8000, 0.5), 24);
}

TEST(FalseAlarmsOfMany, AreAsManyAsAskedForInNoiseAlone) {
  int alarms = 0;
  constexpr int fields = 200;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    MeasuredDifference m;
    m.difference = test::blurred_noise(40, 40, 0, 900 + seed);
    m.deviation = Grid<double>(40, 40, 1.0);
    ChangeOptions options;
    options.false_alarms = 0.2;
    options.simulations = 99;
    options.seed = seed;
    alarms += !find_changes(m, options).places.empty();
  }
  // 40 are expected, with a standard deviation of 5.7.
  EXPECT_GE(alarms, 17);
  EXPECT_LE(alarms, 63);
}

TEST(FindsChanges, Of2NanometresOver20By20) {
  int found = 0;
  constexpr int pairs = 5;
  for (std::uint64_t seed = 9000; seed < 9000 + pairs; ++seed) {
    const ChangingSurface was(seed, 144, WallShape::rounded);
    ChangingSurface is = was;
    is.add(70, 75, 20, 2);
    for (const ChangedPlace& place : changes_between(was, is, seed, 72, 0).places)
      if (std::abs(place.centre_nm.x - 70) < 10 && std::abs(place.centre_nm.y - 75) < 10 &&
          place.mean > 0) {
        ++found;
        break;
      }
  }
  EXPECT_GE(found, pairs - 1);
}

}  // namespace
}  // namespace surf
