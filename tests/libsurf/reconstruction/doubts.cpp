// SPDX-License-Identifier: GPL-3.0-or-later
// What deviations of heights know besides the posterior's draws.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/normal_numbers.h"
#include "core/cubic_sample.h"
#include "reconstruction/depth_doubt.h"
#include "reconstruction/height_intervals.h"
#include "reconstruction/initial_surface.h"
#include "reconstruction/map_deviation.h"
#include "small_scene.h"

namespace surf {
namespace {

using namespace reconstruction;

HeightField step() {
  HeightField surface;
  surface.pitch_x_nm = surface.pitch_y_nm = 10;
  surface.z_nm = Grid<double>(80, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 60; x < 80; ++x) surface.z_nm(x, y) = 50;
  return surface;
}

HeightIntervals intervals_of(const HeightField& surface, const CommonDoubts& doubts) {
  return height_intervals(doubts, surface, surface.z_nm, Affine{}, Grid<double>(80, 40, 1.0), 1);
}

TEST(HeightIntervals, AnUncertainPlaceReachesPlateausAndNoLevelGround) {
  const HeightField surface = step();
  const auto added = [&](const CommonDoubts& doubts) {
    return intervals_of(surface, doubts).deviation_nm;
  };
  CommonDoubts place;
  place.place = {16, 16, 0};
  const Grid<double> off = added(place);
  EXPECT_NEAR(off(20, 20), 1, 1e-9);  // ten deviations from the step
  EXPECT_GT(off(57, 20), 15);         // within one
  EXPECT_GT(off(63, 20), 15);
  CommonDoubts along;
  along.place = {0, 16, 0};  // along the step nothing changes
  EXPECT_NEAR(added(along)(57, 20), 1, 1e-9);
  along.place = {16, 16, 16};  // as across it
  EXPECT_GT(added(along)(57, 20), 15);
  CommonDoubts edge;
  edge.edge_px = 0.15;
  EXPECT_NEAR(added(edge)(50, 20), 1, 1e-9);
  HeightField ramp = surface;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 80; ++x) ramp.z_nm(x, y) = 25 * x;
  EXPECT_NEAR(intervals_of(ramp, edge).deviation_nm(60, 20), std::hypot(1, 0.15 * 25), 1e-9);
  CommonDoubts tilt;
  tilt.level = {0.01, 0};
  tilt.middle = {400, 0};
  EXPECT_NEAR(added(tilt)(70, 20), std::hypot(1, 3), 1e-9);
  EXPECT_NEAR(added(tilt)(40, 20), 1, 1e-9);
}

TEST(HeightIntervals, DisplacedWallsStayBetweenGroundAndPlateau) {
  const HeightField surface = step();
  CommonDoubts place;
  place.place = {16, 16, 0};
  const HeightIntervals i = intervals_of(surface, place);
  EXPECT_NEAR(i.lower_nm(20, 20), -1.96, 1e-6);
  EXPECT_NEAR(i.upper_nm(20, 20), 1.96, 1e-6);
  for (int x = 57; x < 64; ++x) {
    EXPECT_GT(i.lower_nm(x, 20), -6) << x;  // the cubic between samples overshoots by 3.5 nm
    EXPECT_LT(i.upper_nm(x, 20), 56) << x;
    // A normal distribution of this deviation would reach beyond both.
    EXPECT_GT(4 * i.deviation_nm(x, 20), i.upper_nm(x, 20) - i.lower_nm(x, 20)) << x;
  }
  EXPECT_GT(i.upper_nm(57, 20), 45);  // either may be there
  EXPECT_LT(i.lower_nm(62, 20), 5);
  EXPECT_EQ(height_intervals(place, surface, surface.z_nm, Affine{}, Grid<double>(80, 40, 1.0), 3)
                .upper_nm,
            i.upper_nm);
}

/// Hills 60 nm high, every 200 nm along both axes.
HeightField hills() {
  HeightField surface;
  surface.pitch_x_nm = surface.pitch_y_nm = 10;
  surface.z_nm = Grid<double>(80, 80);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 80; ++x)
      surface.z_nm(x, y) = 30 * std::sin(M_PI * x / 10) * std::sin(M_PI * y / 10);
  return surface;
}

TEST(MapDeviation, FollowsFromWhatWallsMayBeDisplacedBy) {
  const HeightField surface = hills();
  const auto known = [&](double heights_nm, const CommonDoubts& doubts) {
    return map_deviation(surface, Grid<double>(80, 80, heights_nm), doubts, Affine{});
  };
  // Heights that are hardly known leave it to them: twice as far off, twice as uncertain.
  const MapDeviation once = known(1e3, {}), twice = known(2e3, {});
  EXPECT_NEAR(twice.middle_x_nm / once.middle_x_nm, 2, 0.01);
  EXPECT_NEAR(twice.scale_y / once.scale_y, 2, 0.01);
  EXPECT_NEAR(twice.rotation_rad / once.rotation_rad, 2, 0.01);
  EXPECT_NEAR(once.middle_x_nm, once.middle_y_nm, 1e-3 * once.middle_x_nm);
  // The mean square slope along x is a quarter of (3 pi)^2, that of differences 0.967 of it. A
  // hundred samples count once.
  const double slopes = 78 * 78 * 0.967 * 0.25 * std::pow(30 * M_PI / 100, 2) / 100;
  EXPECT_NEAR(once.middle_x_nm, 1e3 / std::sqrt(slopes), 0.05 * once.middle_x_nm);
  // Turned and shifted back to the middle: lengths of the image's size turn by what shifts.
  EXPECT_NEAR(once.scale_x * 400 / std::sqrt(3) / once.middle_x_nm, 1, 0.1);
  // What walls may be displaced by, and everything.
  EXPECT_GT(known(0, {.edge_px = 0.2}).middle_x_nm, known(0, {.edge_px = 0.1}).middle_x_nm);
  const MapDeviation moved = known(1, {.place = {16, 0, 0}}), held = known(1, {});
  EXPECT_NEAR(moved.middle_x_nm, std::hypot(held.middle_x_nm, 40), 1e-6);
  EXPECT_EQ(moved.middle_y_nm, held.middle_y_nm);
  EXPECT_GT(held.middle_x_nm, 2.9);  // three tenths of a pixel
}

TEST(MapDeviation, SaysWhatNoWallHolds) {
  const MapDeviation d = map_deviation(step(), Grid<double>(80, 40, 1.0), {}, Affine{});
  EXPECT_TRUE(std::isinf(d.middle_y_nm));
  EXPECT_TRUE(std::isinf(d.scale_x));  // one wall has no distance to another
  HeightField flat = step();
  flat.z_nm = Grid<double>(80, 40);
  EXPECT_TRUE(std::isinf(map_deviation(flat, Grid<double>(80, 40, 1.0), {}, Affine{}).middle_x_nm));
}

TEST(HeightIntervals, HoldNinetyFivePercentOfDraws) {
  HeightField surface = step();
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 80; ++x) surface.z_nm(x, y) = 40 * std::exp(-std::pow((x - 40) / 6.0, 2));
  CommonDoubts doubts;
  doubts.place = {4, 1, 0.5};
  doubts.edge_px = 0.2;
  doubts.level = {0.002, 0};
  const HeightIntervals i = intervals_of(surface, doubts);
  NormalNumbers normal(7, 1);
  constexpr int draws = 4000;
  for (const int x : {30, 34, 37, 40, 45}) {
    double inside = 0;
    for (int d = 0; d < draws; ++d) {
      const double first = normal();
      const double by_x = 2 * first + 0.2 * normal(),
                   by_y = 0.25 * first + std::sqrt(1 - 0.0625) * normal() + 0.2 * normal();
      const CubicSample there(x + by_x, 20 + by_y, 80, 40);
      const double z = there.value(surface.z_nm) + normal() + 0.002 * 10 * x * normal();
      inside += z >= i.lower_nm(x, 20) && z <= i.upper_nm(x, 20);
    }
    EXPECT_NEAR(inside / draws, 0.95, 0.02) << x;  // 64 draws know it to 1 %
  }
}

/// Ground with a trench that the tip does not enter.
double trench(Point2 p) { return -60 * std::exp(-std::pow(p.x / 70, 8)); }

/// The doubt in the middle of the trench, and on level ground, for a surface that bridges it.
std::pair<double, double> doubts_of(double gain) {
  test::SmallScene scene(5, 64, 48, 0.5, trench);
  scene.sem.gains = {gain};
  scene.afm.tip = parabolic_tip(1000, {20, 20, 15, 15});  // so flat that it stays out
  Objective o{.prior = CurvaturePrior(10, 2e-3), .frame = frame_of(&scene.afm, &scene.sem, 4)};
  o.afm.emplace(scene.afm, eroded(scene.afm, 1), o.frame, scene.sem.sem_to_afm, 1);
  o.sem.emplace(scene.sem, o.frame, 4, 4, 1);
  Unknowns at{Grid<double>(72, 56), scene.sem.sem_to_afm, {scene.sem.gains, scene.sem.offset}};
  at.z_nm(2, 2) = -60;  // as low as anything is
  for (int y = 0; y < 56; ++y)
    for (int x = 0; x < 72; ++x)
      if (std::abs(o.frame.origin_x_nm + 10 * x) < 80) at.z_nm(x, y) = -12;
  const Grid<double> doubt = depth_doubt(o, at, o.evaluate(at), 1);
  double touched = 0, n = 0;
  for (int y = 10; y < 46; ++y)
    for (int x = 50; x < 66; ++x) touched += doubt(x, y), n += 1;
  return {doubt(36, 28), touched / n};
}

TEST(DepthDoubt, IsWhatNothingExcludesWhereTheTipDidNotReach) {
  const auto [blind, ground] = doubts_of(1e-3);  // an image that says nothing
  EXPECT_GT(blind, 12);
  EXPECT_LT(ground, 2);
  const auto [seen, same_ground] = doubts_of(100);
  EXPECT_LT(seen, 0.7 * blind);
  EXPECT_LT(same_ground, 2);
}

}  // namespace
}  // namespace surf
