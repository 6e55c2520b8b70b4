// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/row_level.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

/// A wavy line along x, the same in every row, each row shifted.
HeightField shifted_rows(int width, int height, std::vector<double>& shifts) {
  HeightField f;
  f.z_nm = Grid<double>(width, height);
  for (int y = 0; y < height; ++y) {
    shifts.push_back(y * 7 % 5);
    for (int x = 0; x < width; ++x) f.z_nm(x, y) = 100 + std::sin(0.3 * x) + shifts.back();
  }
  return f;
}

void expect_level(const HeightField& f, int x) {
  for (int y = 1; y < f.z_nm.height(); ++y) {
    if (!f.is_valid(x, y)) continue;
    EXPECT_NEAR(f.z_nm(x, y), f.z_nm(x, 0), 1e-12) << y;
  }
}

TEST(LevelRows, TakesStepsBetweenRowsOff) {
  for (const RowMethod method : {RowMethod::median, RowMethod::difference}) {
    std::vector<double> shifts;
    HeightField f = shifted_rows(31, 15, shifts);
    const RowLevel r = level_rows(f, method);
    expect_level(f, 4);
    EXPECT_NEAR(f.z_nm(4, 0), 100 + std::sin(1.2) + 2, 1e-12) << "the level of the whole is kept";
    for (std::size_t y = 0; y < shifts.size(); ++y)
      EXPECT_NEAR(r.offsets_nm[y], shifts[y] - 2, 1e-12);
    EXPECT_EQ(r.rows_without_samples, 0);
  }
}

TEST(LevelRows, MasksKeepFeaturesFromDeciding) {
  for (const RowMethod method : {RowMethod::median, RowMethod::difference}) {
    std::vector<double> shifts;
    HeightField f = shifted_rows(30, 15, shifts);
    Mask use(30, 15, 1);
    for (int y = 4; y < 9; ++y)
      for (int x = 5; x < 25; ++x) f.z_nm(x, y) += 50, use(x, y) = 0;
    HeightField without = f;
    level_rows(f, method, use);
    // Medians of other parts of the wave differ a little; differences do not.
    for (int y = 1; y < 15; ++y)
      EXPECT_NEAR(f.z_nm(2, y), f.z_nm(2, 0), method == RowMethod::median ? 1.5 : 1e-12);
    level_rows(without, method);
    EXPECT_GT(std::fabs(without.z_nm(2, 6) - without.z_nm(2, 0)), 10);
  }
}

TEST(LevelRows, RowsWithoutSamplesFollowTheNearest) {
  for (const RowMethod method : {RowMethod::median, RowMethod::difference}) {
    std::vector<double> shifts;
    HeightField f = shifted_rows(31, 15, shifts);
    f.valid = Mask(31, 15, 1);
    for (int x = 0; x < 31; ++x) f.valid(x, 7) = 0, f.z_nm(x, 7) = NAN;
    const RowLevel r = level_rows(f, method);
    EXPECT_EQ(r.rows_without_samples, 1);
    EXPECT_EQ(r.offsets_nm[7], r.offsets_nm[6]);
    expect_level(f, 4);
    EXPECT_TRUE(std::isnan(f.z_nm(4, 7)));
  }
}

TEST(LevelRows, RefusesNothing) {
  std::vector<double> shifts;
  HeightField f = shifted_rows(5, 5, shifts);
  EXPECT_THROW(level_rows(f, RowMethod::median, Mask(5, 5, 0)), InvalidInput);
  EXPECT_THROW(level_rows(f, RowMethod::median, Mask(4, 5, 1)), InvalidInput);
}

}  // namespace
}  // namespace surf
