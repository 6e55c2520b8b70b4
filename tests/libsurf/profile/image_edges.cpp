// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/image_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "surf/core/error.h"
#include "surf/profile/fit_profile.h"

namespace surf {
namespace {

/// Bright rims at walls, darker ground beside them.
double across(double u) {
  return 1 + 0.2 * (u > 0) + std::exp(-0.5 * u * u / 9) -
         0.2 * std::exp(-0.5 * (u + 10) * (u + 10) / 20);
}

/// Lines of 80 nm at 50 and 220 nm, and half of a third one.
PlacedImage lines() {
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = 2;
  image.values = Grid<double>(200, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 200; ++x) {
      const double at = 2 * x;
      double nearest = -1e9;
      for (const double left : {50.0, 220.0, 390.0})
        nearest = std::max(nearest, std::min(at - left, left + 80 - at));
      image.values(x, y) = across(nearest);
    }
  return image;
}

TEST(ImageEdges, FindsLinesAsAWholeAndTrenchesBetween) {
  const ThresholdEdges e = find_edges(lines(), FeatureKind::line);
  ASSERT_EQ(e.edges.size(), 4u);
  EXPECT_TRUE(e.edges[0].material_right);
  EXPECT_FALSE(e.edges[1].material_right);
  EXPECT_EQ(e.edges[0].feature, e.edges[1].feature);
  EXPECT_NE(e.edges[1].feature, e.edges[2].feature);
  const double width = e.edges[1].place_nm - e.edges[0].place_nm;
  EXPECT_NEAR(width, 86, 3);  // a little outside of the walls
  EXPECT_NEAR(e.edges[2].place_nm - e.edges[0].place_nm, 170, 0.1);
  EXPECT_EQ(e.places_nm[0].size(), 20u);
  EXPECT_NEAR(e.places_nm[0][7], e.edges[0].place_nm, 0.1);
  const ThresholdEdges gaps = find_edges(lines(), FeatureKind::trench);
  ASSERT_EQ(gaps.edges.size(), 4u);
  EXPECT_FALSE(gaps.edges[0].material_right);
  EXPECT_NEAR(gaps.edges[1].place_nm - gaps.edges[0].place_nm, 170 - width, 0.1);
}

TEST(ImageEdges, ThePitchIsSeenWhereOneLineAloneIsWhole) {
  PlacedImage image = lines();
  EXPECT_NEAR(find_edges(image, FeatureKind::line).pitch_nm, 170, 0.5);
  PlacedImage part = image;
  part.values = Grid<double>(120, 20);  // from 90 to 330 nm: the first line's right wall
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 120; ++x) part.values(x, y) = image.values(x + 45, y);
  const ThresholdEdges one = find_edges(part, FeatureKind::line);
  EXPECT_EQ(one.edges.size(), 2u);
  EXPECT_NEAR(one.pitch_nm, 170, 0.5);
  ASSERT_EQ(one.cut_off.size(), 1u);
  EXPECT_FALSE(one.cut_off[0].material_right);
  EXPECT_NEAR(one.edges[1].rim_nm - one.cut_off[0].place_nm, 170, 0.1);
  EXPECT_GT(one.edges[0].rim_nm, one.edges[0].place_nm);  // on the material's side
  // From the first line's left rim to the last one's: what lies beside them is not seen.
  for (const int from : {20, 21, 22, 23}) {
    part.values = Grid<double>(152 - from, 20);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < part.values.width(); ++x) part.values(x, y) = image.values(x + from, y);
    EXPECT_NEAR(find_edges(part, FeatureKind::trench).pitch_nm, 170, 2) << from;
  }
  part.values = Grid<double>(70, 20);  // one line, nothing else
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 70; ++x) part.values(x, y) = image.values(x + 95, y);
  EXPECT_EQ(find_edges(part, FeatureKind::line).pitch_nm, 0);
}

// The second line's left wall has no rim, so that two right walls follow each other.
TEST(ImageEdges, AWallAtTheImagesEndIsToldByItsOwnLevels) {
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = 2;
  image.values = Grid<double>(200, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 200; ++x) {
      const double at = 120 + 2 * x;
      double nearest = 130 - at;
      for (const double left : {220.0, 390.0})
        nearest = std::max(nearest, std::min(at - left, left + 80 - at));
      const bool faint = at > 190 && at < 250;
      image.values(x, y) = faint ? 1 + 0.2 * (at > 220) : across(nearest);
    }
  EXPECT_NEAR(find_edges(image, FeatureKind::line).pitch_nm, 170, 1);
}

TEST(ImageEdges, NoiseOfABrightTopIsNoRim) {
  PlacedImage image = lines();
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 200; ++x)
      image.values(x, y) += 0.05 * std::sin(1.7 * x) * (image.values(x, y) > 0.5);
  EXPECT_EQ(find_edges(image, FeatureKind::line).edges.size(), 4u);
}

TEST(ImageEdges, AHigherThresholdLiesFurtherIn) {
  const double low = find_edges(lines(), FeatureKind::line, 0.2).edges[0].place_nm,
               high = find_edges(lines(), FeatureKind::line, 0.8).edges[0].place_nm;
  EXPECT_LT(low + 1, high);
}

TEST(ImageEdges, AnImageWithoutRimsIsRefused) {
  PlacedImage flat = lines();
  std::ranges::fill(flat.values.data(), 3.0);
  EXPECT_THAT([&] { find_edges(flat, FeatureKind::line); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("no line is seen")));
  EXPECT_THROW(find_hole(flat), InvalidInput);
}

PlacedImage hole() {
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = 3;
  image.values = Grid<double>(80, 80);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 80; ++x)
      image.values(x, y) = across(std::hypot(3 * x - 115.0, 3 * y - 124.0) - 60) -
                           0.4 * (std::hypot(3 * x - 115.0, 3 * y - 124.0) < 50);
  return image;
}

TEST(ImageEdges, FindsAHolesMiddleAndRadius) {
  const Circle c = find_hole(hole());
  EXPECT_NEAR(c.x_nm, 115, 1.5);
  EXPECT_NEAR(c.y_nm, 124, 1.5);
  EXPECT_NEAR(c.radius_nm, 60, 2);
  PlacedImage marked = hole();  // a mark beside it, whose pixels are 0
  marked.valid = Mask(80, 80, 1);
  for (int y = 0; y < 16; ++y)
    for (int x = 64; x < 80; ++x) marked.values(x, y) = -5, marked.valid(x, y) = 0;
  EXPECT_NEAR(find_hole(marked).x_nm, 115, 1.5);
  const PlacedImage around = unrolled(hole(), {115, 124, 60});
  EXPECT_NEAR(around.pitch_y_nm * around.values.height(), 2 * M_PI * 60, 1e-6);
  for (int y = 0; y < around.values.height(); ++y)
    EXPECT_NEAR(around.values(20, y), 2 + 0.1, 0.25) << y;  // on the rim
  const ProfileData data = profile_data(hole(), c, 1e9);
  EXPECT_TRUE(data.closed);
  EXPECT_EQ(data.edges.size(), 1u);
  EXPECT_GT(data.samples.size(), 4000u);
}

TEST(ImageEdges, ACutThroughAHoleHasStraightWalls) {
  const ProfileData data = profile_data(hole(), HoleCut{{115, 124, 60}, 210, 1});
  ASSERT_EQ(data.edges.size(), 2u);
  EXPECT_FALSE(data.edges[0].material_right);
  EXPECT_TRUE(data.edges[1].material_right);
  EXPECT_NEAR(data.rows * data.row_distance_nm, 48, 1e-9);
  std::array<int, 2> on_rim{};
  for (const ProfileSample& s : data.samples) {
    EXPECT_GE(s.row, 0);
    EXPECT_LT(s.row, data.rows);
    EXPECT_EQ(s.edge == 1, s.x_nm >= 0);
    if (std::abs(std::abs(s.x_nm) - 60) > 2) continue;
    EXPECT_NEAR(s.value, across(std::abs(s.x_nm) - 60), 0.05) << s.x_nm << " in row " << s.row;
    ++on_rim[static_cast<std::size_t>(s.edge)];
  }
  EXPECT_GT(on_rim[0], 15);
  EXPECT_GT(on_rim[1], 15);
  // A beam that leans sees the cut shortened.
  const ProfileData leaning = profile_data(hole(), HoleCut{{115, 124, 60}, 0, 0.9});
  EXPECT_EQ(leaning.edges[1].place_nm, 54);
}

}  // namespace
}  // namespace surf
