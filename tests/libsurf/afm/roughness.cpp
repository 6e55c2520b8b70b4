// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/roughness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

TEST(Roughness, OfASineIsKnown) {
  HeightField f;
  f.z_nm = Grid<double>(400, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 400; ++x)
      f.z_nm(x, y) = 1e6 + 3 * std::sin(2 * M_PI * (x + 0.5) / 40) * (y % 2 ? 1 : -1);
  const Roughness r = measure_roughness(f);
  EXPECT_NEAR(r.sq_nm, 3 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(r.sa_nm, 6 / M_PI, 3e-3);
  EXPECT_NEAR(r.sz_nm, 6, 0.02);
  EXPECT_NEAR(r.ssk, 0, 1e-6);
  EXPECT_NEAR(r.sku, 1.5, 1e-6);
  EXPECT_NEAR(r.mean_nm, 1e6, 1e-9);
  EXPECT_EQ(r.samples, 16000u);
  EXPECT_LT(r.tilt.tilt_deg(), 0.1);
}

TEST(Roughness, SaysWhatTiltIsLeftAndWhatItAdds) {
  HeightField f;
  f.z_nm = Grid<double>(101, 11);
  f.pitch_x_nm = 2;
  f.valid = Mask(101, 11, 1);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 101; ++x) f.z_nm(x, y) = 0.1 * x + ((x + y) % 2 ? 0.5 : -0.5);
  f.valid(50, 5) = 0, f.z_nm(50, 5) = NAN;
  const Roughness r = measure_roughness(f);
  EXPECT_NEAR(r.tilt.slope_x, 0.05, 1e-4);
  EXPECT_NEAR(r.sq_levelled_nm, 0.5, 1e-3);
  EXPECT_NEAR(r.sq_nm, std::sqrt(0.25 + 0.01 * (101 * 101 - 1) / 12.0), 2e-3);
}

TEST(Roughness, OfAMaskIsThatOfItsSamples) {
  HeightField f;
  f.z_nm = Grid<double>(10, 10, 5.0);
  f.z_nm(9, 9) = 1000;
  Mask use(10, 10, 1);
  use(9, 9) = 0;
  const Roughness r = measure_roughness(f, use);
  EXPECT_EQ(r.sz_nm, 0);
  EXPECT_NEAR(r.sq_nm, 0, 1e-12);
  EXPECT_THROW(measure_roughness(f, Mask(10, 10, 0)), InvalidInput);
}

}  // namespace
}  // namespace surf
