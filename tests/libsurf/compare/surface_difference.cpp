// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/compare/surface_difference.h"

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

HeightField scan(const ChangingSurface& surface, double x_nm, double noise_nm = 0) {
  Measuring m;
  m.x_nm = x_nm, m.noise_nm = noise_nm;
  return measured(surface, m);
}

SurfaceAlignment shifted_by(double x_nm) {
  SurfaceAlignment a;
  a.verdict = AlignmentVerdict::held;
  a.shift_nm = {x_nm, 0};
  return a;
}

TEST(SurfaceDifference, OfAShiftedSurfaceIsWithinItsErrors) {
  const ChangingSurface surface(1, 192, WallShape::rounded);
  const SurfaceDifference d = surface_difference(scan(surface, 0), scan(surface, 1), shifted_by(1));
  int beyond = 0, samples = 0;
  for (std::size_t i = 0; i < d.difference_nm.size(); ++i) {
    if (!d.valid.includes(i)) continue;
    ++samples;
    beyond += std::abs(d.difference_nm.data()[i]) > 0.05 + 2 * d.interpolation_nm.data()[i];
  }
  EXPECT_GT(samples, 8000);
  EXPECT_LT(beyond, samples / 200);
}

TEST(SurfaceDifference, OfWholeSamplesIsExact) {
  const ChangingSurface surface(2, 192, WallShape::rounded);
  const SurfaceDifference d = surface_difference(scan(surface, 0), scan(surface, 4), shifted_by(4));
  for (std::size_t i = 0; i < d.difference_nm.size(); ++i) {
    EXPECT_NEAR(d.difference_nm.data()[i], 0, 1e-9);
    EXPECT_NEAR(d.interpolation_nm.data()[i], 0, 1e-6);
  }
  EXPECT_NEAR(d.averaged_share, 1, 1e-9);
  EXPECT_EQ(d.valid(0, 5), 0);  // `after` begins behind
}

TEST(SurfaceDifference, KnowsWhatAveragingDoesToNoise) {
  const ChangingSurface flat(3, 192, WallShape::rounded, 3, 0);
  const HeightField quiet = scan(flat, 0), noisy = scan(flat, 1, 0.5);
  const SurfaceDifference d = surface_difference(quiet, noisy, shifted_by(1));
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < d.difference_nm.size(); ++i)
    if (d.valid.includes(i)) squares += std::pow(d.difference_nm.data()[i], 2), ++n;
  EXPECT_NEAR(std::sqrt(squares / n) / 0.5, d.averaged_share, 0.04);
  EXPECT_LT(d.averaged_share, 0.9);
}

TEST(SurfaceDifference, HolesStayHolesAndNothingElseIsLost) {
  const ChangingSurface surface(4, 192, WallShape::rounded);
  HeightField after = scan(surface, 0);
  after.valid = Mask(96, 96, 1);
  after.valid(50, 50) = 0;
  after.z_nm(50, 50) = std::numeric_limits<double>::quiet_NaN();
  const SurfaceDifference d = surface_difference(scan(surface, 0), after, shifted_by(0));
  EXPECT_EQ(d.valid(50, 50), 0);
  EXPECT_EQ(d.valid(54, 50), 1);
  for (const double v : d.difference_nm.data()) EXPECT_TRUE(std::isfinite(v));
  for (const double v : d.interpolation_nm.data()) EXPECT_TRUE(std::isfinite(v));
  HeightField far = after;
  far.origin_x_nm = 1e5;
  EXPECT_THROW(surface_difference(after, far, shifted_by(0)), InvalidInput);
}

TEST(SurfaceDifference, TheShiftsErrorIsLargeWhereSlopesAre) {
  const ChangingSurface surface(5, 192, WallShape::rounded);
  SurfaceAlignment a = shifted_by(1);
  a.covariance[0] = 0.04 * 0.04;
  const SurfaceDifference d = surface_difference(scan(surface, 0), scan(surface, 1), a);
  ASSERT_EQ(d.common_nm.size(), 1u);
  double most = 0;
  for (const double v : d.common_nm[0].data()) most = std::max(most, std::abs(v));
  EXPECT_GT(most, 0.2);  // walls of 5 nm per nm and more
  EXPECT_LT(most, 1.5);
}

TEST(MovedDeviation, IsTheLargestOfTheNeighbours) {
  const HeightField field = scan(ChangingSurface(6, 192, WallShape::ramp), 0);
  Grid<double> deviation(96, 96, 1);
  deviation(40, 40) = 7;
  const Grid<double> moved = moved_deviation(field, field, deviation, shifted_by(1));
  EXPECT_EQ(moved(40, 40), 7);
  EXPECT_EQ(moved(41, 40), 7);
  EXPECT_EQ(moved(44, 40), 1);
  EXPECT_EQ(moved(0, 40), 0);
}

}  // namespace
}  // namespace surf
