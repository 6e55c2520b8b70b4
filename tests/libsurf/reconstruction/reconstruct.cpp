// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/reconstruct.h"

#include <gtest/gtest.h>

#include "small_scene.h"

namespace surf {
namespace {

TEST(Reconstruct, BothImagesGiveTheSurfaceBetterThanTheScanAlone) {
  const test::SmallScene scene;
  const Reconstruction both = reconstruct(&scene.afm, &scene.sem);
  EXPECT_LT(scene.rms_error(both.surface), 0.6 * scene.rms_error(both.start));
  std::printf("start %.3f both %.3f\n", scene.rms_error(both.start), scene.rms_error(both.surface));
  for (const ScaleReport& s : both.scales)
    std::printf("  %.3g afm %.1f sem %.1f prior %.1f it %d ev %d pr %d %s | %.3f %.3f\n", s.sigma_px, s.afm, s.sem, s.prior, s.iterations,
                s.evaluations, s.products, s.ended.c_str(), s.afm_residual.deviation, s.sem_residual.deviation);
}

}  // namespace
}  // namespace surf
