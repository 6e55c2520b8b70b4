// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/hough_plane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/afm/noise.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

constexpr double slope_x = 0.1, slope_y = -0.03, sigma_nm = 0.2;

/// A noisy tilted substrate.
HeightField substrate(int width, int height) {
  HeightField f;
  f.z_nm = simulate_noise({0.8, sigma_nm * sigma_nm * 0.36}, width, height, 3);
  f.pitch_x_nm = 4, f.pitch_y_nm = 8, f.origin_x_nm = 100;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) f.z_nm(x, y) += 30 + slope_x * f.x_nm(x) + slope_y * f.y_nm(y);
  return f;
}

/// Pillars of 16 x 16 samples with sloping tops of random heights stand on all but `share` of it.
HeightField under_pillars(int size, double share, Mask& bare) {
  HeightField f = substrate(size, size);
  bare = Mask(size, size, 1);
  RandomStream random(1, 0, 0);
  for (int j = 0; j < size; j += 16) {
    for (int i = 0; i < size; i += 16) {
      if (random.uniform() < share) continue;
      const double top = 5 + 55 * random.uniform(), slope = random.uniform() - 0.5;
      for (int y = j; y < j + 16; ++y)
        for (int x = i; x < i + 16; ++x) f.z_nm(x, y) += top + slope * (x - i), bare(x, y) = 0;
    }
  }
  return f;
}

void expect_substrate(const HeightField& f, const HoughSummary& s, double off_nm) {
  for (const int y : {0, f.z_nm.height() - 1})
    for (const int x : {0, f.z_nm.width() - 1})
      EXPECT_NEAR(s.plane.at(f.x_nm(x), f.y_nm(y)), 30 + slope_x * f.x_nm(x) + slope_y * f.y_nm(y),
                  off_nm);
}

TEST(FindPlane, FindsASubstrateThatIsLessThanAThirdOfTheImage) {
  Mask bare;
  const HeightField f = under_pillars(256, 0.27, bare);
  const HoughSummary s = find_plane(f);
  expect_substrate(f, s, 0.1);
  EXPECT_EQ(s.verdict, HoughVerdict::clear);
  std::size_t right = 0, total = 0, marked = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    total += bare.data()[i], marked += s.inliers.data()[i];
    right += bare.data()[i] && s.inliers.data()[i];
  }
  EXPECT_LT(static_cast<double>(total), 0.3 * 256 * 256) << "the scene is not the one meant";
  EXPECT_GT(static_cast<double>(right), 0.9 * static_cast<double>(total));
  EXPECT_GT(static_cast<double>(right), 0.9 * static_cast<double>(marked));
  EXPECT_NEAR(s.inlier_share, static_cast<double>(marked) / (256 * 256), 1e-12);
  EXPECT_GT(s.inlier_share, 5 * s.runner_up_share);
  EXPECT_NEAR(s.inlier_rms_nm, sigma_nm, 0.1 * sigma_nm);
  const Plane mean = fit_plane(f);
  EXPECT_GT(mean.height_nm - s.plane.height_nm, 10) << "least squares alone would have done";
}

TEST(FindPlane, SaysWhenTwoPlanesHoldAsMuch) {
  HeightField f = substrate(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      if (x / 32 % 2) f.z_nm(x, y) += 20;
  const HoughSummary s = find_plane(f);
  EXPECT_EQ(s.verdict, HoughVerdict::contested);
  EXPECT_NEAR(std::fabs(s.runner_up.height_nm - s.plane.height_nm), 20, 1);
  EXPECT_NEAR(s.plane.slope_x, slope_x, 1e-3);
}

TEST(FindPlane, TakesTheLargerOfTwoTerraces) {
  HeightField f = substrate(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      if (x % 64 < 20) f.z_nm(x, y) += 20;
  const HoughSummary s = find_plane(f);
  EXPECT_EQ(s.verdict, HoughVerdict::clear);
  expect_substrate(f, s, 0.1);
  EXPECT_NEAR(s.runner_up_share / s.inlier_share, 20.0 / 44, 0.05);
}

TEST(FindPlane, SaysWhenThereIsNoPlane) {
  EXPECT_NE(find_plane(make_rough({255, 255, 1}, 5, 10, 3)).verdict, HoughVerdict::clear);
}

TEST(FindPlane, IsNotMisledByHolesMasksSpikesOrHeightsFarFromZero) {
  HeightField f = substrate(200, 120);
  f.z_nm(5, 5) = 1e6, f.z_nm(100, 70) = -1e5;
  f.valid = Mask(200, 120, 1);
  Mask use(200, 120, 1);
  for (int y = 0; y < 120; ++y) {
    f.valid(9, y) = 0, f.z_nm(9, y) = NAN;
    for (int x = 40; x < 190; ++x) f.z_nm(x, y) += 50, use(x, y) = 0;
  }
  const HoughSummary s = find_plane(f, {}, use);
  EXPECT_EQ(s.verdict, HoughVerdict::clear);
  expect_substrate(f, s, 0.2);
  for (int y = 0; y < 120; ++y) EXPECT_EQ(s.inliers(100, y) + s.inliers(9, y), 0);
  EXPECT_EQ(s.inliers(5, 5), 0);
}

TEST(FindPlane, OfAnExactPlaneIsThatPlane) {
  HeightField f = substrate(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) f.z_nm(x, y) = 30 + slope_x * f.x_nm(x) + slope_y * f.y_nm(y);
  const HoughSummary s = find_plane(f);
  EXPECT_EQ(s.inlier_share, 1);
  EXPECT_EQ(s.verdict, HoughVerdict::clear);
  expect_substrate(f, s, 1e-9);
}

TEST(FindPlane, KeepsToAToleranceThatIsGiven) {
  Mask bare;
  const HoughSummary s = find_plane(under_pillars(256, 0.5, bare), {.tolerance_nm = 0.3});
  EXPECT_EQ(s.tolerance_nm, 0.3);
  EXPECT_NEAR(s.inlier_share, 0.5 * std::erf(0.3 / sigma_nm / std::sqrt(2.0)), 0.05);
}

TEST(FindPlane, RefusesTooLittle) {
  EXPECT_THROW(find_plane(substrate(9, 9), {.tolerance_nm = -1}), UsageError);
  EXPECT_THROW(find_plane(substrate(9, 9), {}, Mask(9, 9, 0)), InvalidInput);
  HeightField tiny = substrate(2, 2);
  EXPECT_NO_THROW(find_plane(tiny));
}

}  // namespace
}  // namespace surf
