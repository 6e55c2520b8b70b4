// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/morphology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "afm_test.h"
#include "surf/afm/resample.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using namespace test;

constexpr double step = 0x1p-6;                        // heights are multiples of it
const MorphologyOptions exact{.quantum_nm = 0x1p-10};  // so that nothing is rounded

void expect_equal(const HeightField& field, const Grid<double>& expected) {
  for (int y = 0; y < expected.height(); ++y)
    for (int x = 0; x < expected.width(); ++x) {
      ASSERT_EQ(field.is_valid(x, y), std::isfinite(expected(x, y))) << x << ", " << y;
      if (!field.is_valid(x, y)) continue;
      ASSERT_EQ(field.z_nm(x, y), expected(x, y)) << x << ", " << y;
    }
}

bool same(const HeightField& a, const HeightField& b) {
  return a.z_nm == b.z_nm && a.valid == b.valid;
}

// Everywhere where both are known.
bool is_below(const HeightField& low, const HeightField& high) {
  for (int y = 0; y < low.z_nm.height(); ++y)
    for (int x = 0; x < low.z_nm.width(); ++x)
      if (low.is_valid(x, y) && high.is_valid(x, y) && low.z_nm(x, y) > high.z_nm(x, y))
        return false;
  return true;
}

}  // namespace

TEST(Morphology, IsTheDefinition) {
  for (const double holes : {0.0, 0.2, 0.9}) {
    const HeightField field = random_field(3, 37, 29, step, holes);
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 4}, {5, 13}, {90, 70}}) {
      SCOPED_TRACE(testing::Message() << "holes " << holes << ", tip " << w << " x " << h);
      const Tip tip = random_tip(4, w, h, step);
      expect_equal(dilate(field, tip, exact), naive_dilation(field, tip));
      expect_equal(erode(field, tip, exact), naive_erosion(field, tip));
    }
  }
}

TEST(Morphology, KeepsPitchAndPlace) {
  const HeightField field = random_field(3, 9, 8, step),
                    out = dilate(field, random_tip(4, 3, 3, step));
  EXPECT_EQ(out.pitch_x_nm, field.pitch_x_nm);
  EXPECT_EQ(out.pitch_y_nm, field.pitch_y_nm);
  EXPECT_EQ(out.origin_x_nm, field.origin_x_nm);
  EXPECT_EQ(out.origin_y_nm, field.origin_y_nm);
}

TEST(Morphology, RoundsToTheQuantumItChooses) {
  HeightField field = random_field(5, 64, 40, 1e-7);
  const Tip tip = random_tip(6, 9, 9, 1e-7);
  for (const double scale : {1e-12, 1.0, 1e9})
    for (const double lift : {0.0, 1e6}) {
      HeightField scaled = field;
      Tip scaled_tip = tip;
      for (double& z : scaled.z_nm.data()) z = (z + lift) * scale;
      for (double& z : scaled_tip.z_nm.data()) z *= scale;
      const Grid<double> expected = naive_dilation(scaled, scaled_tip);
      const HeightField image = dilate(scaled, scaled_tip);
      const double range = scale * (10 + 2 * 6);
      // Half a quantum each for surface and tip, and the digits that a double has.
      const double bound = std::max(0x1p-28 * range, 0x1p-49 * scale * (lift + 10));
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(image.z_nm.data()[i], expected.data()[i], bound) << scale << ' ' << lift;
    }
}

// dilate(S) <= I if and only if S <= erode(I).
TEST(Morphology, ErosionAndDilationAreAdjoint) {
  int below = 0, above = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const HeightField image = random_field(100 + seed, 12, 10, 0.5);
    const Tip tip = random_tip(300 + seed, 3, 4, 0.5);
    HeightField surface = erode(image, tip, exact);
    RandomStream random(seed, 3, 0);  // about half the cases break the bound somewhere
    for (double& z : surface.z_nm.data()) z += random.uniform() < 0.006 ? 0.5 : -random.uniform();
    for (double& z : surface.z_nm.data()) z = std::floor(z * 1024) / 1024;
    const bool bounded = is_below(surface, erode(image, tip, exact));
    EXPECT_EQ(is_below(dilate(surface, tip, exact), image), bounded);
    ++(bounded ? below : above);
  }
  EXPECT_GT(below, 20);
  EXPECT_GT(above, 20);
}

TEST(Morphology, OpeningAndClosingAreIdempotentAndBound) {
  for (const double holes : {0.0, 0.2}) {
    const HeightField field = random_field(7, 60, 41, step, holes);
    const Tip tip = random_tip(8, 8, 5, step);
    const HeightField opened = opening(field, tip, exact), closed = closing(field, tip, exact);
    EXPECT_TRUE(is_below(opened, field));
    EXPECT_TRUE(is_below(field, closed));
    EXPECT_FALSE(is_below(field, opened));
    EXPECT_FALSE(is_below(closed, field));
    if (holes > 0) continue;  // holes are filled by the first, and the second then sees more
    EXPECT_TRUE(same(opening(opened, tip, exact), opened));
    EXPECT_TRUE(same(closing(closed, tip, exact), closed));
    EXPECT_TRUE(same(dilate(erode(field, tip, exact), tip, exact), opened));
    EXPECT_TRUE(same(erode(dilate(field, tip, exact), tip, exact), closed));
  }
}

TEST(Morphology, OpeningReproducesADilation) {
  const Tip tip = random_tip(9, 6, 9, step);
  const HeightField image = dilate(random_field(10, 50, 33, step), tip, exact);
  EXPECT_TRUE(same(opening(image, tip, exact), image));
}

// Beyond the border nothing is known: a wall just outside cannot raise the image, a pit cannot
// bound it.
TEST(Morphology, WhatIsKnownAtTheBorderIsABoundOfTheWhole) {
  const HeightField whole = random_field(11, 40, 30, step);
  const Tip tip = random_tip(12, 7, 7, step);
  HeightField part = whole;
  part.valid = Mask(40, 30, 0);
  for (int y = 8; y < 22; ++y)
    for (int x = 8; x < 32; ++x) part.valid(x, y) = 1;
  EXPECT_TRUE(is_below(dilate(part, tip, exact), dilate(whole, tip, exact)));
  EXPECT_TRUE(is_below(erode(whole, tip, exact), erode(part, tip, exact)));
}

TEST(Morphology, ContactsReproduceTheDilation) {
  const HeightField field = random_field(13, 45, 38, step, 0.3);
  const Tip tip = random_tip(14, 9, 6, step);
  for (const int factor : {1, 3}) {
    const MorphologyOptions options{.upsample = factor, .quantum_nm = 0x1p-20};
    const Dilation d = dilate_with_contacts(field, tip, options);
    const HeightField fine = upsampled(field, factor);
    const Tip fine_tip = resampled(tip, tip.pitch_x_nm / factor, tip.pitch_y_nm / factor);
    EXPECT_TRUE(same(d.image, dilate(field, tip, options)));
    for (int y = 0; y < 38; ++y)
      for (int x = 0; x < 45; ++x) {
        const int cx = d.contact_x(x, y), cy = d.contact_y(x, y);
        ASSERT_EQ(cx >= 0, d.image.is_valid(x, y));
        if (cx < 0) continue;
        const int i = factor * x - cx + fine_tip.apex_x, j = factor * y - cy + fine_tip.apex_y;
        ASSERT_NEAR(fine.z_nm(cx, cy) + fine_tip.z_nm(i, j), d.image.z_nm(x, y), 0x1p-19);
      }
  }
}

TEST(Morphology, UpsampledIsTheFineOneSampled) {
  const HeightField field = random_field(15, 14, 11, step, 0.1);
  const Tip tip = random_tip(16, 5, 4, step);
  const MorphologyOptions plain{.quantum_nm = 0x1p-22};
  for (const int factor : {2, 3}) {
    MorphologyOptions options = plain;
    options.upsample = factor;
    const HeightField fine = upsampled(field, factor);
    const Tip fine_tip = resampled(tip, tip.pitch_x_nm / factor, tip.pitch_y_nm / factor);
    const auto expect_sampled = [&](const HeightField& result, const HeightField& full) {
      for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 14; ++x) {
          ASSERT_EQ(result.is_valid(x, y), full.is_valid(factor * x, factor * y));
          if (!result.is_valid(x, y)) continue;
          ASSERT_NEAR(result.z_nm(x, y), full.z_nm(factor * x, factor * y),
                      0x1p-21);  // thirds are rounded
        }
    };
    expect_sampled(dilate(field, tip, options), dilate(fine, fine_tip, plain));
    expect_sampled(erode(field, tip, options), erode(fine, fine_tip, plain));
    expect_sampled(opening(field, tip, options), opening(fine, fine_tip, plain));
    expect_sampled(closing(field, tip, options), closing(fine, fine_tip, plain));
  }
  EXPECT_TRUE(same(upsampled(random_field(15, 14, 11, step), 1), random_field(15, 14, 11, step)));
}

// With the sphere sampled at a third of the pitch, a spike's image is rounder than with all of it.
TEST(Noncontact, IsFinerOnAFinerGrid) {
  HeightField spike{{2, 2}, Grid<double>(21, 21, 0.0)};
  spike.z_nm(10, 10) = 30;
  const Tip point{{2, 2}, Grid<double>(1, 1, 0.0), 0, 0};
  const HeightField fine = dilate_noncontact(spike, point, 5, {.upsample = 4});
  EXPECT_TRUE(is_below(dilate_noncontact(spike, point, 5), fine));
  EXPECT_FALSE(is_below(fine, dilate_noncontact(spike, point, 5)));
  EXPECT_NEAR(fine.z_nm(10, 10), 35, 1e-5);
}

TEST(Noncontact, LiftsAPlaneAndRoundsAStepBySphereAndTip) {
  HeightField step_field{{}, Grid<double>(60, 8, 0.0)};
  for (int y = 0; y < 8; ++y)
    for (int x = 30; x < 60; ++x) step_field.z_nm(x, y) = 20;
  const Tip sharp = conical_tip(0, 1e-3, {1, 1, 41, 41});
  const HeightField image = dilate_noncontact(step_field, sharp, 5);
  EXPECT_NEAR(image.z_nm(5, 4), 5, 1e-5);
  EXPECT_NEAR(image.z_nm(50, 4), 25, 1e-5);
  // 3 nm before the edge the sphere of 5 nm stands 4 nm over it.
  EXPECT_NEAR(image.z_nm(27, 4), 24, 1e-5);
  EXPECT_NEAR(image.z_nm(24, 4), 5, 1e-5);
  EXPECT_TRUE(same(dilate_noncontact(step_field, sharp, 0), dilate(step_field, sharp)));
}

TEST(Noncontact, ErosionBoundsTheSurface) {
  const HeightField surface = random_field(19, 40, 30, step);
  const Tip tip = random_tip(20, 5, 5, step);
  const HeightField bound = erode_noncontact(dilate_noncontact(surface, tip, 4), tip, 4);
  for (std::size_t i = 0; i < surface.z_nm.size(); ++i)
    EXPECT_LE(surface.z_nm.data()[i], bound.z_nm.data()[i] + 1e-6);
}

TEST(Morphology, SameBytesForAnyNumberOfThreads) {
  const HeightField field = random_field(21, 150, 90, 1e-5, 0.05);
  const Tip tip = random_tip(22, 19, 17, 1e-5);
  const HeightField one = erode(field, tip, {.threads = 1});
  for (const int threads : {2, 5}) EXPECT_TRUE(same(erode(field, tip, {.threads = threads}), one));
}

TEST(Morphology, RefusesWhatCannotBeUsed) {
  const HeightField field = random_field(23, 8, 8, step);
  const Tip tip = random_tip(24, 3, 3, step);
  Tip other = tip;
  other.pitch_x_nm *= 1.01;
  EXPECT_THROW(dilate(field, other), InvalidInput);
  EXPECT_THROW(dilate(field, tip, {.quantum_nm = 1e-9}), InvalidInput);
  EXPECT_THROW(dilate(field, tip, {.quantum_nm = -1}), InvalidInput);
  EXPECT_THROW(dilate(field, tip, {.quantum_nm = std::nan("")}), InvalidInput);
  EXPECT_THROW(dilate(field, tip, {.upsample = 0}), InvalidInput);
  EXPECT_THROW(dilate_noncontact(field, tip, -1), InvalidInput);
  EXPECT_THROW(erode_noncontact(field, tip, std::nan("")), InvalidInput);
  HeightField nothing = field;
  nothing.valid = Mask(8, 8, 0);
  EXPECT_THROW(erode(nothing, tip), InvalidInput);
  HeightField huge = field;
  huge.z_nm(2, 2) = 1e300;
  EXPECT_THROW(erode(huge, tip), InvalidInput);
}

TEST(Morphology, FlatStaysFlat) {
  for (const double z : {0.0, 1e5, -3.25}) {
    const HeightField flat{{}, Grid<double>(5, 4, z)};
    const Tip point{{1, 1}, Grid<double>(1, 1, 0.0), 0, 0};
    EXPECT_EQ(dilate(flat, point).z_nm, flat.z_nm);
    EXPECT_EQ(erode(flat, point).z_nm, flat.z_nm);
  }
}

}  // namespace surf
