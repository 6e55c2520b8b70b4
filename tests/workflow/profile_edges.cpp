// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_edges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf::workflow {
namespace {

/// A line from 40 to 100 nm, whose rims are 4 nm inside its edges.
std::vector<FittedEdge> line() {
  std::vector<FittedEdge> out(2);
  for (FittedEdge& e : out) {
    const bool left = &e == &out.front();
    e.edge.material_right = left;
    e.place_nm = {left ? 40.0 : 100.0, 0.3};
    e.edge.rim_nm = left ? 44 : 96;
    e.smooth_nm = e.rows_nm = {e.place_nm.value - 1, e.place_nm.value + 1};
    e.errors_nm = {0.5, 0.5};
  }
  return out;
}

/// Pixels of 2 nm, the last of them at `last_nm`.
PlacedImage image_to(double last_nm) {
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = 2;
  image.values = Grid<double>(static_cast<int>(last_nm / 2) + 1, 2);
  return image;
}

TEST(ProfileEdges, AWallThatTheImageCutsOffIsAsFarFromItsRimAsOthers) {
  const auto edges = edges_in_sight(image_to(200), {{true, 184}}, line(), {});
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_TRUE(edges[2].edge.material_right);
  EXPECT_DOUBLE_EQ(edges[2].place_nm.value, 180);
  EXPECT_NEAR(edges[2].place_nm.standard_error, std::hypot(0.3, 0.2), 1e-9);
  EXPECT_EQ(edges[2].smooth_nm, (std::vector<double>{180, 180}));
  EXPECT_NEAR(edges[2].errors_nm[0], 1, 1e-9);
}

TEST(ProfileEdges, WhereTheImagesEndHidesARimWallsGoOnByThePitch) {
  const auto edges = edges_in_sight(image_to(186), {}, line(), {140, 0.4});
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_TRUE(edges[2].edge.material_right);
  EXPECT_DOUBLE_EQ(edges[2].place_nm.value, 180);
  EXPECT_DOUBLE_EQ(edges[2].place_nm.standard_error, 0.5);

  const auto left = edges_in_sight(image_to(150), {}, line(), {100, 0.4});
  ASSERT_EQ(left.size(), 4U) << "the line before ends at 0, the next begins at 140";
  EXPECT_FALSE(left[2].edge.material_right);
  EXPECT_DOUBLE_EQ(left[2].place_nm.value, 0);
  EXPECT_DOUBLE_EQ(left[3].place_nm.value, 140);
}

TEST(ProfileEdges, AWallThatWouldBeSeenAndIsNotIsNotThere) {
  EXPECT_EQ(edges_in_sight(image_to(192), {}, line(), {140, 0.4}).size(), 2U);
  EXPECT_EQ(edges_in_sight(image_to(186), {}, line(), {}).size(), 2U) << "features do not repeat";
  const std::vector<FittedEdge> one{line().front()};
  EXPECT_EQ(edges_in_sight(image_to(186), {}, one, {140, 0.4}).size(), 1U);
}

TEST(ProfileEdges, AWallWhoseRimIsSeenIsNotAddedAgain) {
  const auto edges = edges_in_sight(image_to(188), {{true, 184.5}}, line(), {140, 0.4});
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_DOUBLE_EQ(edges[2].place_nm.value, 180.5);
}

}  // namespace
}  // namespace surf::workflow
