// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/tip_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "small_scene.h"
#include "surf/core/error.h"

namespace surf {
namespace {

TEST(TipSearch, FindsADullTipFromASharpOneAndADisplacedMap) {
  test::SmallScene scene(4, 90, 70, 0.5);
  const Tip sharp = conical_tip(10, 0.3, {20, 20, 7, 7});
  Affine map = scene.sem.sem_to_afm;
  map.x0 += 12, map.y0 -= 9;
  const FoundTip found =
      find_tip_by_sem(scene.afm.image, sharp, scene.sem.image, *scene.sem.model, map, 1);
  EXPECT_LT(found.residual, 0.9 * found.residual_before);
  // A parabola of 80 nm: 5.6 nm deep at 30 nm, 22.5 nm at 60 nm.
  const Tip& tip = found.tip;
  const auto depth = [&](int samples) {
    return -0.25 * (tip.z_nm(tip.apex_x + samples, tip.apex_y) +
                    tip.z_nm(tip.apex_x - samples, tip.apex_y) +
                    tip.z_nm(tip.apex_x, tip.apex_y + samples) +
                    tip.z_nm(tip.apex_x, tip.apex_y - samples));
  };
  EXPECT_NEAR(depth(2), 10, 3);
  EXPECT_NEAR(depth(3), 22.5, 5);
  const Point2 there = found.sem_to_afm({0, 0}), right = scene.sem.sem_to_afm({0, 0});
  EXPECT_LT(std::hypot(there.x - right.x, there.y - right.y), 6);
}

TEST(TipSearch, TellsHowFarATipIsBeyondABlindBound) {
  const Tip tip = conical_tip(60, 0.4, {20, 20, 11, 11});
  const TipBound dull{conical_tip(300, 0.5, {20, 20, 11, 11}), 1},
      sharp{conical_tip(8, 0.2, {20, 20, 11, 11}), 0.2};
  EXPECT_EQ(beyond(dull, tip), 0);
  EXPECT_EQ(beyond({tip, 0.1}, tip), 0);
  EXPECT_GT(beyond(sharp, tip), 20);
  EXPECT_EQ(beyond({sharp.tip, 0}, tip), 0);  // without a threshold there is no bound
}

TEST(TipSearch, IsTheSameOnAnyNumberOfThreads) {
  const test::SmallScene scene;
  const auto run = [&](int threads) {
    return find_tip_by_sem(scene.afm.image, scene.afm.tip, scene.sem.image, *scene.sem.model,
                           scene.sem.sem_to_afm, threads);
  };
  const FoundTip one = run(1), two = run(2);
  EXPECT_EQ(one.tip.z_nm, two.tip.z_nm);
  EXPECT_EQ(one.sem_to_afm, two.sem_to_afm);
}

TEST(TipSearch, RefusesImagesApartAndStopsWhenTold) {
  const test::SmallScene scene;
  Affine away = scene.sem.sem_to_afm;
  away.x0 += 1e5;
  EXPECT_THROW(
      find_tip_by_sem(scene.afm.image, scene.afm.tip, scene.sem.image, *scene.sem.model, away),
      InvalidInput);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(find_tip_by_sem(scene.afm.image, scene.afm.tip, scene.sem.image, *scene.sem.model,
                               scene.sem.sem_to_afm, 1, {{}, &cancel}),
               Interrupted);
}

}  // namespace
}  // namespace surf
