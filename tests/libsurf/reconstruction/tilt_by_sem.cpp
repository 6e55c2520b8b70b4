// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/tilt_by_sem.h"

#include <gtest/gtest.h>

#include <cmath>

#include "small_scene.h"

namespace surf {
namespace {

/// The true surface, tilted the other way.
HeightField tilted(const test::SmallScene& scene, double x, double y) {
  HeightField surface = scene.truth;
  for (int j = 0; j < surface.z_nm.height(); ++j)
    for (int i = 0; i < surface.z_nm.width(); ++i) {
      const Point2 p = scene.sem.sem_to_afm({surface.x_nm(i), surface.y_nm(j)});
      surface.z_nm(i, j) -= x * p.x + y * p.y;
    }
  return surface;
}

TEST(TiltBySem, FindsATiltWithinItsStandardErrors) {
  double squares = 0;
  constexpr int scenes = 12;
  for (int seed = 1; seed <= scenes; ++seed) {
    const test::SmallScene scene(static_cast<std::uint64_t>(seed), 56, 40, 1, test::rough_height);
    const SemTilt found = tilt_by_sem(tilted(scene, 0.02, -0.015), scene.sem, scene.sem.sem_to_afm,
                                      {0, 0, {0.1, 0.1}}, 1);
    EXPECT_LT(found.doubt.x, 0.01);
    squares += std::pow((found.x - 0.02) / found.doubt.x, 2) +
               std::pow((found.y + 0.015) / found.doubt.y, 2);
  }
  // Chi-squared with 24 degrees of freedom: 99.9 % between 6 and 55.
  EXPECT_GT(squares, 6);
  EXPECT_LT(squares, 55);
}

TEST(TiltBySem, KeepsToWhatIsKnown) {
  const test::SmallScene scene(3, 56, 40, 1, test::rough_height);
  const HeightField surface = tilted(scene, 0.02, 0);
  const SemTilt kept =
      tilt_by_sem(surface, scene.sem, scene.sem.sem_to_afm, {0.001, 0.002, {1e-6, 1e-6}}, 1);
  EXPECT_NEAR(kept.x, 0.001, 1e-5);
  EXPECT_NEAR(kept.y, 0.002, 1e-5);
  const SemTilt none = tilt_by_sem(surface, scene.sem, scene.sem.sem_to_afm, {0, 0, {0, 0}}, 1);
  EXPECT_EQ(none.x, 0);
  EXPECT_EQ(none.iterations, 0);
}

TEST(TiltBySem, FlatGroundIsNotTilted) {
  const test::SmallScene scene(3, 56, 40, 1, [](Point2) { return 5.0; });
  const SemTilt tilt =
      tilt_by_sem(scene.truth, scene.sem, scene.sem.sem_to_afm, {0, 0, {1e-3, 1e-3}}, 1);
  EXPECT_NEAR(tilt.x, 0, 1e-6);
  EXPECT_NEAR(tilt.y, 0, 1e-6);
  EXPECT_NEAR(tilt.doubt.x, 1e-3, 1e-6);
}

TEST(TiltBySem, WhatTheModelMayBeOffByMakesItDoubtful) {
  test::SmallScene scene(3, 56, 40, 1, test::rough_height);
  const SemTilt sure =
      tilt_by_sem(scene.truth, scene.sem, scene.sem.sem_to_afm, {0, 0, {0.1, 0.1}}, 1);
  scene.sem.discrepancy = usual_discrepancy(scene.sem.image, 0.5);
  const SemTilt doubtful =
      tilt_by_sem(scene.truth, scene.sem, scene.sem.sem_to_afm, {0, 0, {0.1, 0.1}}, 1);
  EXPECT_GT(doubtful.doubt.x, 1.2 * sure.doubt.x);
}

}  // namespace
}  // namespace surf
