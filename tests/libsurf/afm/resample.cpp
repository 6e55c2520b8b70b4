// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/resample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm_test.h"
#include "surf/core/error.h"

namespace surf {

using namespace test;

TEST(ResampledTip, KeepsTheApexAndWhatIsBilinear) {
  Tip tip{{2, 3}, Grid<double>(7, 5), 2, 3};
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) tip.z_nm(x, y) = -std::abs(x - 2) * 4.0 - std::abs(y - 3) * 6.0;
  for (const double ratio : {0.25, 0.7, 1.0, 1.5}) {
    const Tip out = resampled(tip, 2 * ratio, 3 * ratio);
    validate(out);
    EXPECT_EQ(out.apex_x, static_cast<int>(2 / ratio + 1e-9));
    EXPECT_EQ(out.z_nm.width(), out.apex_x + 1 + static_cast<int>(4 / ratio + 1e-9));
    for (int y = 0; y < out.z_nm.height(); ++y)
      for (int x = 0; x < out.z_nm.width(); ++x)
        EXPECT_NEAR(out.z_nm(x, y),
                    -std::abs(x - out.apex_x) * 4 * ratio - std::abs(y - out.apex_y) * 6 * ratio,
                    1e-9);
  }
}

TEST(ResampledTip, OfMissingSamplesNothingIsMade) {
  Tip tip{{1, 1}, Grid<double>(3, 1, -1.0), 0, 0};
  tip.z_nm.data() = {0, -1, none};
  const Tip out = resampled(tip, 0.5, 1);
  EXPECT_EQ(out.z_nm.data(), (std::vector<double>{0, -0.5, -1, none, none}));
}

TEST(ResampledTip, Refuses) {
  const Tip tip = random_tip(1, 5, 5, 0.1);
  EXPECT_THROW(resampled(tip, 0, 1), InvalidInput);
  EXPECT_THROW(resampled(tip, 1, std::nan("")), InvalidInput);
  EXPECT_THROW(resampled(tip, 1e-6, 1e-6), InvalidInput);
}

TEST(Upsampled, InterpolatesAndSpreadsHoles) {
  HeightField field{{2, 4, 5, 6}, Grid<double>(3, 2), Mask(3, 2, 1)};
  field.z_nm.data() = {0, 2, 4, 8, 10, 12};
  field.valid(2, 1) = 0;
  const HeightField fine = upsampled(field, 2);
  EXPECT_EQ(fine.z_nm.width(), 5);
  EXPECT_EQ(fine.pitch_y_nm, 2);
  EXPECT_EQ(fine.origin_x_nm, 5);
  EXPECT_EQ(fine.z_nm(1, 1), 5);
  EXPECT_EQ(fine.valid.data(),
            (std::vector<unsigned char>{1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0}));
  EXPECT_THROW(upsampled(field, 0), InvalidInput);
  EXPECT_THROW(upsampled(field, 33), InvalidInput);
}

TEST(ResampledField, KeepsPlanesAndItsPlace) {
  HeightField field{{2, 4, 5, 6}, Grid<double>(11, 7)};
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 11; ++x) field.z_nm(x, y) = 3 * field.x_nm(x) - field.y_nm(y);
  for (const double pitch : {0.7, 2.0, 3.0, 8.0}) {
    const HeightField out = resampled(field, pitch);
    EXPECT_EQ(out.z_nm.width(), static_cast<int>(20 / pitch + 1e-9) + 1);
    EXPECT_EQ(out.z_nm.height(), static_cast<int>(24 / pitch + 1e-9) + 1);
    EXPECT_EQ(out.origin_x_nm, 5);
    for (int y = 0; y < out.z_nm.height(); ++y)
      for (int x = 0; x < out.z_nm.width(); ++x)
        EXPECT_NEAR(out.z_nm(x, y), 3 * out.x_nm(x) - out.y_nm(y), 1e-9);
  }
}

TEST(ResampledField, SpreadsHolesAndRefuses) {
  HeightField field{{2, 2}, Grid<double>(3, 2), Mask(3, 2, 1)};
  field.valid(2, 1) = 0;
  EXPECT_EQ(resampled(field, 1).valid.data(),
            (std::vector<unsigned char>{1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0}));
  for (const double bad : {0.0, -1.0, std::nan(""), 5.0, 1e-6})
    EXPECT_THROW(resampled(field, bad), InvalidInput);
}

}  // namespace surf
