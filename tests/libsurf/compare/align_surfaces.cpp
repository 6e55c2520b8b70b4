// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/align_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "changing_surface.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using test::ChangingSurface;
using test::measured;
using test::Measuring;
using test::WallShape;

Measuring first_scan(std::uint64_t seed) {
  Measuring m;
  m.seed = 100 * seed;
  return m;
}

Measuring second_scan(std::uint64_t seed, double x_nm, double y_nm) {
  Measuring m = first_scan(seed);
  m.seed += 1;
  m.x_nm = x_nm, m.y_nm = y_nm;
  m.lift_nm = 3, m.tilt_x = 0.01, m.tilt_y = -0.005;
  return m;
}

double error_of(double c) { return std::sqrt(c); }

TEST(AlignSurfaces, FindsFractionsOfSamplesWithoutBias) {
  double sum = 0, squares = 0, count = 0;
  int seed = 0;
  for (const double x_nm : {0.5, 1.0, -3.0, 2.5, -0.7})
    for (int again = 0; again < 2; ++again) {
      const ChangingSurface surface(std::uint64_t(++seed), 192, WallShape::rounded);
      const SurfaceAlignment a =
          align_surfaces(measured(surface, first_scan(std::uint64_t(seed))),
                         measured(surface, second_scan(std::uint64_t(seed), x_nm, -x_nm / 2)));
      ASSERT_EQ(a.verdict, AlignmentVerdict::aligned) << seed << ": " << a.reason;
      for (const auto& [off, variance] : {std::pair(a.shift_nm.x - x_nm, a.covariance[0]),
                                          {a.shift_nm.y + x_nm / 2, a.covariance[6]}}) {
        EXPECT_LT(std::abs(off), 0.1) << seed;  // a twentieth of a sample
        const double z = off / std::sqrt(variance);
        sum += z, squares += z * z, ++count;
      }
    }
  // Standard errors are stated with room for what interpolation does, so they may be too large.
  EXPECT_LT(std::abs(sum / count), 4.5 / std::sqrt(count));
  EXPECT_LT(squares / count, 2.2);
}

TEST(AlignSurfaces, ChangedPlacesDoNotDrawIt) {
  ChangingSurface surface(5, 192, WallShape::rounded);
  const HeightField before = measured(surface, first_scan(5));
  surface.add(60, 70, 50, 30);
  surface.add(140, 120, 40, -25);
  const SurfaceAlignment a = align_surfaces(before, measured(surface, second_scan(5, 2.6, 1.1)));
  ASSERT_EQ(a.verdict, AlignmentVerdict::aligned) << a.reason;
  EXPECT_NEAR(a.shift_nm.x, 2.6, 0.1);
  EXPECT_NEAR(a.shift_nm.y, 1.1, 0.1);
  EXPECT_NEAR(a.tilt_x, 0.01, 0.002);
}

TEST(AlignSurfaces, LiesWhereItIsToldToWhenHeld) {
  const ChangingSurface surface(6, 192, WallShape::rounded);
  const SurfaceAlignment a = align_surfaces(
      measured(surface, first_scan(6)), measured(surface, second_scan(6, 0, 0)), {.held = true});
  EXPECT_EQ(a.verdict, AlignmentVerdict::held);
  EXPECT_EQ(a.shift_nm, (Point2{0, 0}));
  EXPECT_EQ(error_of(a.covariance[0]), 0);
  EXPECT_NEAR(a.tilt_x, 0.01, 0.001);
}

TEST(AlignSurfaces, OtherPitchesAndHolesAreTaken) {
  const ChangingSurface surface(7, 192, WallShape::rounded);
  HeightField before = measured(surface, first_scan(7));
  before.valid = Mask(96, 96, 1);
  for (int y = 20; y < 30; ++y)
    for (int x = 0; x < 96; ++x) {
      before.valid(x, y) = 0;
      before.z_nm(x, y) = std::numeric_limits<double>::quiet_NaN();
    }
  Measuring second = second_scan(7, 3.3, -1.7);
  second.pitch_nm = 1.5, second.width = second.height = 128;
  const SurfaceAlignment a = align_surfaces(before, measured(surface, second));
  ASSERT_EQ(a.verdict, AlignmentVerdict::aligned) << a.reason;
  EXPECT_NEAR(a.shift_nm.x, 3.3, 0.1);
  EXPECT_NEAR(a.shift_nm.y, -1.7, 0.1);
  for (const double c : a.covariance) EXPECT_TRUE(std::isfinite(c));
}

int related_of(std::uint64_t from, std::uint64_t pairs) {
  int related = 0;
  for (std::uint64_t seed = from; seed < from + pairs; ++seed) {
    const ChangingSurface one(seed, 192, WallShape::rounded),
        other(seed + 500, 192, WallShape::rounded);
    const SurfaceAlignment a =
        align_surfaces(measured(one, first_scan(seed)), measured(other, second_scan(seed, 1, 1)));
    related += a.usable();
    EXPECT_EQ(a.reason.empty(), a.usable());
  }
  return related;
}

TEST(AlignSurfaces, OtherSpecimensGetAVerdict) { EXPECT_EQ(related_of(1, 5), 0); }
TEST(AlignSurfacesOfMany, OtherSpecimensGetAVerdict) { EXPECT_EQ(related_of(101, 60), 0); }

TEST(AlignSurfaces, SlidingAndRepeatingSurfacesAreAmbiguous) {
  HeightField lines = measured(ChangingSurface(8, 192, WallShape::ramp, 3, 0), first_scan(8));
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) lines.z_nm(x, y) += 20 * std::sin(2 * 3.14159265 * x / 12);
  HeightField again =
      measured(ChangingSurface(9, 192, WallShape::ramp, 3, 0), second_scan(9, 0, 0));
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) again.z_nm(x, y) += 20 * std::sin(2 * 3.14159265 * x / 12);
  const SurfaceAlignment a = align_surfaces(lines, again);
  EXPECT_FALSE(a.usable());
  EXPECT_NE(a.reason.find("compare."), std::string::npos);
  const SurfaceAlignment b = align_surfaces(lines, again, {.held = true});
  EXPECT_TRUE(b.usable());
}

TEST(AlignSurfaces, BadInputIsRefused) {
  const HeightField field = measured(ChangingSurface(1, 192, WallShape::ramp), first_scan(1));
  HeightField small = field;
  small.z_nm = Grid<double>(8, 8);
  EXPECT_THROW(align_surfaces(field, small), InvalidInput);
  HeightField coarse = field;
  coarse.pitch_x_nm = 20;
  EXPECT_THROW(align_surfaces(field, coarse), InvalidInput);
  HeightField broken = field;
  broken.z_nm(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(align_surfaces(broken, field), InvalidInput);
  EXPECT_THROW(align_surfaces(field, field, {.largest_shift_nm = -1}), UsageError);
  EXPECT_THROW(align_surfaces(field, field, {.least_overlap = 0}), UsageError);
  HeightField far = field;
  far.origin_x_nm = 1e6;
  EXPECT_THROW(align_surfaces(field, far, {.held = true}), InvalidInput);
  CancelToken token;
  token.cancel();
  EXPECT_THROW(align_surfaces(field, field, {.watch = {{}, &token}}), Interrupted);
}

}  // namespace
}  // namespace surf
