// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/pilot.h"

#include "surf/mc/simulate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {
namespace {

Scene scene_of(int pixels) {
  Specimen specimen;
  specimen.materials = {io::find_material("Si", "test")};
  specimen.substrate = Substrate{0, 0.0};
  specimen.bodies = {{"cube", make_box({-20, -20, 0}, {20, 20, 40}), 0}};
  Scan scan;
  scan.width = scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = 60.0 / pixels;
  return Scene(specimen, {}, scan);
}

SimulationOptions options_of(Method method, std::int64_t electrons, double accuracy = 0) {
  SimulationOptions options;
  options.method = method;
  options.budget = ElectronsPerPixel{electrons};
  if (accuracy > 0) options.budget = Accuracy{accuracy};
  options.threads = 2;
  return options;
}

// What it foretells beside what a simulation counts. Times are for bench/.
void expect_foretold(const Scene& scene, const SimulationOptions& options, double seconds,
                     double within) {
  const Pilot pilot = run_pilot(scene, options, seconds);
  const SimulationResult done = simulate(scene, options);
  EXPECT_GT(pilot.units, 0u);
  EXPECT_NEAR(pilot.primaries / static_cast<double>(done.balance.incident), 1, within);
  EXPECT_NEAR(pilot.rays / static_cast<double>(done.balance.rays), 1, within);
  EXPECT_EQ(pilot.library_cascades, done.library_cascades);
  EXPECT_GT(pilot.expected_s, 0);
  EXPECT_GE(pilot.standard_error_s, 0);
  EXPECT_GT(pilot.packed_bytes, 0);
}

TEST(Pilot, TriesAllThatTakesLessThanTheTime) {
  const Scene scene = scene_of(12);
  const SimulationOptions options = options_of(Method::direct, 10);
  const Pilot pilot = run_pilot(scene, options, 30);
  const SimulationResult done = simulate(scene, options);
  EXPECT_TRUE(pilot.whole);
  EXPECT_EQ(pilot.units, pilot.units_in_all);
  EXPECT_EQ(pilot.primaries, static_cast<double>(done.balance.incident));
  EXPECT_NEAR(pilot.rays, static_cast<double>(done.balance.rays), 0.5);
  EXPECT_NEAR(pilot.steps, static_cast<double>(done.balance.steps), 0.5);
  EXPECT_EQ(pilot.standard_error_s, 0);
}

TEST(Pilot, ForetellsFromAPart) {
  expect_foretold(scene_of(48), options_of(Method::direct, 60), 0.3, 0.3);
}

// Four units to a row, of which the first and last see less: every fourth unit alone would be of
// one column.
TEST(Pilot, IsNotMisledByRows) {
  SimulationOptions options = options_of(Method::direct, 100);
  options.tile_pixels = 10;
  expect_foretold(scene_of(40), options, 1, 0.15);
}

TEST(Pilot, ForetellsReplay) {
  expect_foretold(scene_of(64), options_of(Method::replay, 50), 0.3, 0.25);
}

TEST(Pilot, ForetellsAnAccuracy) {
  expect_foretold(scene_of(64), options_of(Method::replay, 1, 0.2), 0.5, 0.4);
}

TEST(Pilot, LongUnitsAreTriedInPieces) {
  const Scene scene = scene_of(64);  // four tiles
  const SimulationOptions options = options_of(Method::direct, 1, 0.02);
  const Pilot pilot = run_pilot(scene, options, 0.3);
  EXPECT_FALSE(pilot.whole);
  EXPECT_EQ(pilot.units_in_all, 4u);
  EXPECT_GT(pilot.expected_s, 0.3);
  EXPECT_LT(pilot.seconds, 0.2 * pilot.expected_s * 2);  // it did not do all of it
}

TEST(Pilot, CanBeCancelled) {
  CancelToken cancel;
  cancel.cancel();
  for (const Method method : {Method::direct, Method::replay}) {
    EXPECT_THROW(run_pilot(scene_of(32), options_of(method, 100), 10, nullptr, {{}, &cancel}),
                 Interrupted);
  }
}

TEST(Pilot, RefusesNoTimeAndBadOptions) {
  EXPECT_THROW(run_pilot(scene_of(8), options_of(Method::direct, 1), 0), UsageError);
  EXPECT_THROW(run_pilot(scene_of(8), options_of(Method::direct, 0), 1), UsageError);
}

}  // namespace
}  // namespace surf::mc
