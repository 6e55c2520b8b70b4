// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/characterizer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm_test.h"
#include "surf/afm/morphology.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using namespace test;

/// Sharp spikes.
HeightField spikes() {
  HeightField f{{}, Grid<double>(100, 90, 0.0)};
  for (const auto& [x, y] : {std::pair{40, 45}, {60, 40}, {50, 55}}) f.z_nm(x, y) = 200;
  return f;
}

Tip asymmetric() { return pyramidal_tip({{0.3, 0.6, 0.9}, 0.4, 2}, {1, 1, 17, 13}); }

HeightField moved(const HeightField& image, int dx, int dy, double dz) {
  HeightField out = image;
  for (int y = 0; y < image.z_nm.height(); ++y)
    for (int x = 0; x < image.z_nm.width(); ++x) {
      const double z = at(image, x - dx, y - dy);
      out.z_nm(x, y) = (z == none ? 0 : z) + dz;
    }
  return out;
}

}  // namespace

TEST(Characterizer, SharpSpikesGiveTheTipAndTheOffset) {
  const Tip tip = asymmetric();
  const HeightField scan = moved(dilate(spikes(), tip), 4, -3, 17);
  const CharacterizedTip found =
      tip_from_characterizer(scan, spikes(), {.width = 17, .height = 13, .search = 6});
  EXPECT_EQ(found.offset_x, 4);
  EXPECT_EQ(found.offset_y, -3);
  EXPECT_NEAR(found.offset_z_nm, 17, 1e-5);
  EXPECT_FALSE(found.offset_at_limit);
  for (std::size_t i = 0; i < tip.z_nm.size(); ++i)
    EXPECT_NEAR(found.tip.z_nm.data()[i], tip.z_nm.data()[i], 1e-5);
  EXPECT_EQ(found.tip.apex_x, tip.apex_x);
}

TEST(Characterizer, WhatItGivesIsAnUpperBoundThatReproducesTheScan) {
  HeightField steps = spikes();
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 100; ++x) steps.z_nm(x, y) = 10 * (x / 20 % 2) + 6 * (y / 25 % 2);
  const Tip tip = asymmetric();
  const CharacterizedTip found =
      tip_from_characterizer(dilate(steps, tip), steps, {.width = 17, .height = 13, .search = 0});
  for (std::size_t i = 0; i < tip.z_nm.size(); ++i)
    EXPECT_GE(found.tip.z_nm.data()[i], tip.z_nm.data()[i] - 1e-5);
  EXPECT_LT(found.residual_nm, 1e-5);
}

TEST(Characterizer, SaysWhenTheOffsetIsAtTheLimit) {
  const HeightField scan = moved(dilate(spikes(), asymmetric()), 6, 0, 0);
  EXPECT_TRUE(tip_from_characterizer(scan, spikes(), {.width = 17, .height = 13, .search = 3})
                  .offset_at_limit);
}

TEST(Characterizer, Refuses) {
  HeightField other = spikes();
  other.pitch_x_nm = 2;
  EXPECT_THROW(tip_from_characterizer(spikes(), other), InvalidInput);
  EXPECT_THROW(tip_from_characterizer(spikes(), spikes(), {.width = 0}), InvalidInput);
  EXPECT_THROW(tip_from_characterizer(spikes(), spikes(), {.search = 60}), InvalidInput);
  HeightField holes = spikes();
  holes.valid = Mask(100, 90, 0);
  EXPECT_THROW(tip_from_characterizer(holes, spikes(), {.width = 9, .height = 9}), InvalidInput);
}

}  // namespace surf
