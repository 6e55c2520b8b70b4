// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/certainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "afm_test.h"
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using namespace test;

constexpr int size = 128;
const Tip cone = conical_tip(8, 0.35, {1, 1, 31, 31});

/// Waves, trenches of 4 nm that the tip does not enter, and lines 12 nm high.
HeightField specimen() {
  HeightField s{{}, Grid<double>(size, size)};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      s.z_nm(x, y) = 3 * std::sin(0.11 * x) * std::cos(0.07 * y) + (x > 60 && x / 16 % 2 ? 12 : 0) -
                     (y % 40 < 4 ? 8 : 0);
  return s;
}

HeightField noisy(HeightField image, double sigma, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  for (double& z : image.z_nm.data()) z += sigma * random_normal(random);
  return image;
}

/// The definition of Pingali and Jain, word by word, on what the image shows.
Mask classical(const HeightField& image, const Grid<double>& r, const Tip& t, double tolerance) {
  const int w = image.z_nm.width(), h = image.z_nm.height();
  Mask certain(w, h, 0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      int contacts = 0, cx = 0, cy = 0;
      for (int j = 0; j < t.z_nm.height(); ++j)
        for (int i = 0; i < t.z_nm.width(); ++i) {
          const int X = x - (i - t.apex_x), Y = y - (j - t.apex_y);
          // r continued: bounded by every image pixel that a tip touching there would meet.
          double here = 1e300;
          if (X >= 0 && Y >= 0 && X < w && Y < h) here = r(X, Y);
          else
            for (int l = 0; l < t.z_nm.height(); ++l)
              for (int k = 0; k < t.z_nm.width(); ++k) {
                const double z = at(image, X + (k - t.apex_x), Y + (l - t.apex_y));
                if (z != none) here = std::min(here, z - t.z_nm(k, l));
              }
          if (here + t.z_nm(i, j) < image.z_nm(x, y) - tolerance) continue;
          ++contacts;
          cx = X;
          cy = Y;
        }
      if (contacts == 1 && cx >= 0 && cy >= 0 && cx < w && cy < h) certain(cx, cy) = 1;
    }
  return certain;
}

struct Judged {
  double certain = 0;  ///< share of all
  double here = 0;     ///< share of these within the bound of the surface
  double near = 0;     ///< ... there, or as near as the map says
};

Judged judge(const CertaintyMap& map, const HeightField& truth, double bound) {
  const auto is_right = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < size && y < size &&
           std::abs(map.surface.z_nm(x, y) - truth.z_nm(x, y)) <= bound;
  };
  Judged j;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int level = map.level(x, y);
      if (level == CertaintyMap::uncertain) continue;
      ++j.certain;
      j.here += is_right(x, y);
      bool near = false;  // anywhere in a square of half side `level` that holds (x, y)
      for (int v = -2 * level; v <= 2 * level; ++v)
        for (int u = -2 * level; u <= 2 * level; ++u) near = near || is_right(x + u, y + v);
      j.near += near;
    }
  j.here /= j.certain;
  j.near /= j.certain;
  j.certain /= size * size;
  return j;
}

}  // namespace

TEST(Certainty, WithoutNoiseItIsTheClassicalMap) {
  const Tip tip = random_tip(2, 5, 4, 1.0 / 64);
  const HeightField image = dilate(random_field(1, 30, 26, 1.0 / 64), tip);
  const CertaintyMap map = certainty_map(image, tip);
  EXPECT_EQ(map.neighbourhood, 0);
  const Mask expected = classical(image, map.surface.z_nm, tip, map.tolerance_nm);
  std::size_t certain = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(map.level.data()[i] == 0, expected.data()[i] == 1) << i;
    certain += expected.data()[i];
  }
  EXPECT_EQ(map.certain, certain);
  EXPECT_GT(certain, 30u);
  EXPECT_LT(certain, 600u);
  EXPECT_EQ(map.unexplained, 0u);
  EXPECT_EQ(map.single + map.ambiguous, map.image_pixels);
}

TEST(Certainty, WithoutNoiseWhatIsCertainIsTheSurface) {
  const HeightField truth = specimen();
  const Judged j = judge(certainty_map(dilate(truth, cone), cone), truth, 1e-5);
  EXPECT_EQ(j.here, 1);
  EXPECT_GT(j.certain, 0.3);
}

// The classical map collapses. 3 sigmas: rare larger noise may break the
// promise; where it is counted that the surface is near, at most 2 in 1000 do.
TEST(Certainty, HoldsWithNoise) {
  const HeightField truth = specimen(), image = dilate(truth, cone);
  const double without = judge(certainty_map(image, cone), truth, 1e-5).certain;
  for (const double sigma : {0.02, 0.1, 0.3}) {
    const HeightField scan = noisy(image, sigma, 7);
    const CertaintyMap map = certainty_map(scan, cone, {.noise_nm = sigma});
    const Judged j = judge(map, truth, 3 * sigma);
    EXPECT_GT(j.certain, 0.75 * without) << sigma;
    EXPECT_GT(j.near, 0.998) << sigma;
    EXPECT_GT(j.here, 0.75) << sigma;
    EXPECT_LT(static_cast<double>(map.unexplained), 0.002 * size * size) << sigma;
    const CertaintyMap plain = certainty_map(scan, cone);
    const double bound = sigma < 0.1 ? 0.7 : 0.3;
    EXPECT_LT(judge(plain, truth, 3 * sigma).certain, bound * without) << sigma;
  }
}

// Wider than the neighbourhood: narrower ones cannot be told from the rim beside them.
TEST(Certainty, BottomsTheTipDoesNotReachAreUncertain) {
  HeightField truth{{}, Grid<double>(60, 40, 0.0)};
  for (int y = 0; y < 40; ++y)
    for (int x = 24; x < 36; ++x) truth.z_nm(x, y) = -30;
  const HeightField image = noisy(dilate(truth, cone), 0.05, 3);
  const CertaintyMap map = certainty_map(image, cone, {.noise_nm = 0.05});
  for (int y = 8; y < 32; ++y)
    for (int x = 26; x < 34; ++x)
      EXPECT_EQ(map.level(x, y), CertaintyMap::uncertain) << x << ", " << y;
}

TEST(Certainty, NoncontactImagesKeepTheirDistance) {
  const HeightField truth = specimen(), image = dilate_noncontact(truth, cone, 4);
  const Judged j = judge(certainty_map(image, cone, {.distance_nm = 4}), truth, 2e-5);
  EXPECT_EQ(j.here, 1);
  EXPECT_GT(j.certain, 0.15);
  // A contact map of the same image would call wrong heights certain.
  EXPECT_LT(judge(certainty_map(image, cone), truth, 2e-5).here, 0.1);
}

// A spike left of the scan shapes its border; what is certain is right nevertheless.
TEST(Certainty, WhatTouchedOutsideIsNotTakenForInside) {
  HeightField whole = specimen();
  for (int y = 0; y < size; y += 5) whole.z_nm(38, y) = 25;
  const HeightField image = dilate(whole, cone);
  HeightField truth{{}, Grid<double>(60, 60)}, part = truth;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      truth.z_nm(x, y) = whole.z_nm(x + 40, y + 30);
      part.z_nm(x, y) = image.z_nm(x + 40, y + 30);
    }
  const CertaintyMap map = certainty_map(part, cone);
  EXPECT_GT(map.certain, 300u);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x)
      if (map.level(x, y) != CertaintyMap::uncertain) {
        EXPECT_NEAR(map.surface.z_nm(x, y), truth.z_nm(x, y), 1e-5) << x << ", " << y;
      }
}

TEST(Certainty, UnexplainedPixelsAreCounted) {
  HeightField image = dilate(specimen(), cone);
  image.z_nm(40, 50) += 5;  // sharper than the tip
  const CertaintyMap map = certainty_map(image, cone, {.noise_nm = 0.1});
  EXPECT_EQ(map.unexplained, 1u);
  EXPECT_EQ(map.image_pixels, static_cast<std::size_t>(size * size));
}

TEST(Certainty, HolesAndThreads) {
  HeightField image = noisy(dilate(specimen(), cone), 0.1, 5);
  image.valid = Mask(size, size, 1);
  for (int y = 20; y < 60; ++y)
    for (int x = 20; x < 70; ++x) image.valid(x, y) = 0;
  const CertaintyMap one = certainty_map(image, cone, {.noise_nm = 0.1, .threads = 1});
  EXPECT_EQ(one.image_pixels, static_cast<std::size_t>(size * size - 40 * 50));
  EXPECT_EQ(certainty_map(image, cone, {.noise_nm = 0.1, .threads = 3}).level, one.level);
}

TEST(Certainty, RefusesWhatIsOutOfRange) {
  const HeightField image = specimen();
  EXPECT_THROW(certainty_map(image, cone, {.noise_nm = -1}), InvalidInput);
  EXPECT_THROW(certainty_map(image, cone, {.noise_nm = std::nan("")}), InvalidInput);
  EXPECT_THROW(certainty_map(image, cone, {.sigmas = 0}), InvalidInput);
  EXPECT_THROW(certainty_map(image, cone, {.neighbourhood = 101}), InvalidInput);
  EXPECT_THROW(certainty_map(image, cone, {.distance_nm = -1}), InvalidInput);
}

TEST(PixelNoise, IsFoundOnASmoothSurface) {
  HeightField image{{}, Grid<double>(200, 200)};
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) image.z_nm(x, y) = 100 + 0.3 * x + 5 * std::sin(0.05 * y);
  EXPECT_NEAR(pixel_noise_nm(noisy(image, 0.2, 11)), 0.2, 0.006);
  EXPECT_LT(pixel_noise_nm(image), 1e-4);
}

}  // namespace surf
