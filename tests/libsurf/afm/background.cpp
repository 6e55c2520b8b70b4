// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/background.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

HeightField field_of(int width, int height, double (*z)(double, double)) {
  HeightField f;
  f.z_nm = Grid<double>(width, height);
  f.pitch_x_nm = 2, f.pitch_y_nm = 5, f.origin_x_nm = -40, f.origin_y_nm = 1e4;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) f.z_nm(x, y) = z(f.x_nm(x), f.y_nm(y));
  return f;
}

double tilted(double x, double y) { return 1e5 + 0.3 * x - 0.02 * y; }
double cubic(double x, double y) {
  const double v = (y - 1e4) / 50, u = x / 40;
  return 7 + u - v + u * v + 3 * v * v - u * u * v + 2 * v * v * v;
}

TEST(FitPlane, FindsAPlaneInRealUnits) {
  const HeightField f = field_of(31, 17, tilted);
  const Plane p = fit_plane(f);
  EXPECT_NEAR(p.slope_x, 0.3, 1e-12);
  EXPECT_NEAR(p.slope_y, -0.02, 1e-12);
  EXPECT_NEAR(p.at(-40, 1e4), tilted(-40, 1e4), 1e-8);
  EXPECT_NEAR(p.tilt_deg(), std::atan(std::hypot(0.3, 0.02)) * 180 / M_PI, 1e-9);
  EXPECT_NEAR(p.uphill_deg(), 360 - std::atan(0.02 / 0.3) * 180 / M_PI, 1e-8);
}

TEST(FitPlane, LeavesOutHolesAndMaskedSamples) {
  HeightField f = field_of(31, 17, tilted);
  f.valid = Mask(31, 17, 1);
  f.valid(3, 3) = 0, f.z_nm(3, 3) = NAN;
  Mask use(31, 17, 1);
  for (int y = 0; y < 9; ++y)
    for (int x = 12; x < 31; ++x) use(x, y) = 0, f.z_nm(x, y) += 500;
  const Plane p = fit_plane(f, use);
  EXPECT_NEAR(p.slope_x, 0.3, 1e-12);
  subtract(f, p);
  EXPECT_TRUE(std::isnan(f.z_nm(3, 3)));
  EXPECT_NEAR(f.z_nm(0, 0), 0, 1e-8);
  EXPECT_NEAR(f.z_nm(20, 2), 500, 1e-8);
}

TEST(FitPolynomial, ReproducesPolynomialsOfItsDegreeFromACornerOfTheImage) {
  const HeightField f = field_of(40, 30, cubic);
  Mask use(40, 30, 0);
  for (int y = 20; y < 30; ++y)
    for (int x = 0; x < 9; ++x) use(x, y) = 1;
  for (const Grid<double>& fitted :
       {fit_polynomial(f, 3), fit_polynomial(f, 6), fit_polynomial(f, 3, use)})
    for (std::size_t i = 0; i < fitted.size(); ++i)
      EXPECT_NEAR(fitted.data()[i], f.z_nm.data()[i], 1e-6);
  EXPECT_GT(std::fabs(fit_polynomial(f, 2)(0, 0) - f.z_nm(0, 0)), 0.1);
}

TEST(FitPolynomial, OfDegreeZeroIsTheMean) {
  HeightField f = field_of(3, 2, tilted);
  f.z_nm.data() = {1, 2, 3, 4, 5, 9};
  EXPECT_NEAR(fit_polynomial(f, 0)(2, 1), 4, 1e-12);
}

// Heights that go together over a few samples: the slopes' errors over those stated have a mean
// square of 1.
TEST(DoubtOfPlane, IsHowFarSlopesAreOff) {
  double square = 0;
  constexpr int scans = 60, size = 64, soft = 3;
  for (std::uint64_t scan = 0; scan < scans; ++scan) {
    RandomStream random(8, scan, 0);
    Grid<double> white(size + soft, size + soft);
    for (double& v : white.data()) v = random.uniform() - 0.5;
    const HeightField f = field_of(size, size, [](double, double) { return 0.0; });
    HeightField rough = f;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (int v = 0; v < soft; ++v)
          for (int u = 0; u < soft; ++u) rough.z_nm(x, y) += white(x + u, y + v);
    const SlopeDoubt doubt = doubt_of_plane(rough);
    const Plane plane = fit_plane(rough);
    square += 0.5 * (std::pow(plane.slope_x / doubt.x, 2) + std::pow(plane.slope_y / doubt.y, 2));
  }
  EXPECT_GT(square / scans, 0.5);
  EXPECT_LT(square / scans, 1.6);
}

TEST(DoubtOfPlane, IsNoneWhereOneBlockHoldsEverything) {
  const HeightField f = field_of(40, 40, tilted);
  Mask use(40, 40, 0);
  for (int y = 2; y < 8; ++y)
    for (int x = 2; x < 8; ++x) use(x, y) = 1;
  const SlopeDoubt doubt = doubt_of_plane(f, use);
  EXPECT_NEAR(doubt.x, 0, 1e-9);
  EXPECT_NEAR(doubt.y, 0, 1e-9);
}

TEST(FitPlane, RefusesSamplesThatDetermineNone) {
  const HeightField f = field_of(9, 9, tilted);
  Mask row(9, 9, 0), diagonal(9, 9, 0), none(9, 9, 0);
  for (int i = 0; i < 9; ++i) row(i, 4) = 1, diagonal(i, i) = 1;
  for (const auto& use : {row, diagonal, none}) EXPECT_THROW(fit_plane(f, use), InvalidInput);
  EXPECT_THROW(fit_plane(f, Mask(3, 3, 1)), InvalidInput);
  EXPECT_THROW(fit_polynomial(f, 7), UsageError);
  EXPECT_THROW(fit_polynomial(f, -1), UsageError);
}

}  // namespace
}  // namespace surf
