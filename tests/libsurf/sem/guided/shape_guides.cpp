// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/shape_guides.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"

namespace surf {
namespace {

/// 40 nm high from x = 32 on, with pixels of 2 nm; nothing is seen in row 0.
SeenSurface step() {
  SeenSurface s{2, 2, Grid<double>(64, 40, 0.0), Grid<double>(64, 40, 1.0),
                Grid<std::uint8_t>(64, 40, 1)};
  for (int x = 0; x < 64; ++x) s.seen(x, 0) = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 32; x < 64; ++x) s.height_nm(x, y) = 40;
  return s;
}

const Grid<double>& named(const std::vector<Guide>& guides, const std::string& name) {
  return std::ranges::find(guides, name, &Guide::name)->values;
}

TEST(ShapeGuides, SayWhereStepsAre) {
  const std::vector<Guide> guides = shape_guides(step());
  const Grid<double>&below = named(guides, "step below"), &above = named(guides, "step above"),
        &height = named(guides, "height within 8 nm"), &sky = named(guides, "sky");
  EXPECT_EQ(below(32, 20), 1);
  EXPECT_EQ(below(31, 20), 0);
  EXPECT_EQ(above(31, 20), 1);
  EXPECT_LT(above(20, 20), 0.05);
  EXPECT_GT(height(33, 20), 0.5);
  EXPECT_NEAR(height(30, 20), -height(33, 20), 1e-6);
  EXPECT_NEAR(sky(60, 20), 1, 1e-12);
  EXPECT_LT(sky(31, 20), 0.6);
  EXPECT_GT(sky(5, 20), sky(31, 20));
  for (const Guide& guide : guides) {
    EXPECT_FALSE(guide.predicts);
    for (int x = 0; x < 64; ++x) EXPECT_EQ(guide.values(x, 0), 0) << guide.name;
    for (const double value : guide.values.data()) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(ShapeGuides, LookAtTheSkyAllAround) {
  const SeenSurface east = step();
  SeenSurface west = east, north = east;
  north.height_nm = Grid<double>(64, 40, 0.0);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x) {
      west.height_nm(x, y) = east.height_nm(63 - x, y);
      if (y >= 20) north.height_nm(x, y) = 40;
    }
  const Grid<double> to_east = named(shape_guides(east), "sky"),
                     to_west = named(shape_guides(west), "sky"),
                     to_north = named(shape_guides(north), "sky");
  for (int x = 20; x < 32; ++x) EXPECT_NEAR(to_west(63 - x, 20), to_east(x, 20), 1e-12) << x;
  EXPECT_LT(to_north(32, 19), 0.6);
}

TEST(ShapeGuides, TiltIsThePathUnderTheSurface) {
  SeenSurface s = step();
  s.cosine(10, 10) = 0.5;
  s.cosine(11, 10) = 1e-9;
  const std::vector<Guide> guides = shape_guides(s);
  EXPECT_DOUBLE_EQ(named(guides, "tilt")(10, 10), 1);
  EXPECT_DOUBLE_EQ(named(guides, "tilt")(11, 10), 19);  // no longer than that
}

TEST(ShapeGuides, AreBlurredAsTheBeamIs) {
  SeenSurface s = step();
  s.cosine(10, 10) = 0.5;
  s.spot_nm = 4;
  const Grid<double> tilt = named(shape_guides(s), "tilt");
  EXPECT_LT(tilt(10, 10), 0.1);
  EXPECT_GT(tilt(12, 10), 0.01);
}

TEST(ShapeGuides, DoNotDependOnThreadsAndRefuseSizesThatDiffer) {
  const std::vector<Guide> one = shape_guides(step(), 1), three = shape_guides(step(), 3);
  for (std::size_t g = 0; g < one.size(); ++g) EXPECT_EQ(one[g].values, three[g].values);
  SeenSurface s = step();
  s.cosine = Grid<double>(3, 3);
  EXPECT_THROW(shape_guides(s), InvalidInput);
  s = step();
  s.pixel_x_nm = 0;
  EXPECT_THROW(shape_guides(s), InvalidInput);
}

}  // namespace
}  // namespace surf
