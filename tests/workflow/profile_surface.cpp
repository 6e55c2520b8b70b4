// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_surface.h"

#include <gtest/gtest.h>

namespace surf::workflow {
namespace {

/// A line of 60 nm, straight, 100 nm high, from 40 to 100 nm in an image that ends at 186.
struct Line {
  PlacedImage image;
  ProfileSummary summary;

  Line() {
    image.pitch_x_nm = image.pitch_y_nm = 2;
    image.values = Grid<double>(94, 2);
    SightFit& sight = summary.fit.sights.emplace_back();
    for (const bool left : {true, false}) {
      FittedEdge& e = sight.edges.emplace_back();
      e.edge.material_right = left;
      e.place_nm = {left ? 40.0 : 100.0, 0.3};
      e.edge.rim_nm = left ? 44 : 96;
      e.smooth_nm = e.rows_nm = {e.place_nm.value, e.place_nm.value};
      e.errors_nm = {0, 0};
      sight.profiles.push_back({left, {-5, 5}, {1, 2}, {0.1, 0.1}, {1, 2}});
    }
    summary.fit.left = {Measured{60, 0.3}, {100, 2}, {90, 0.2}, {0, 0}, {0, 0}};
    summary.fit.right = summary.fit.left;
  }
};

TEST(ProfileSurface, IsAsHighAsTheWallsBetweenEdges) {
  Line line;
  add_surface(line.image, line.summary);
  EXPECT_EQ(line.summary.surface.z_nm(10, 0), 0);
  EXPECT_EQ(line.summary.surface.z_nm(35, 0), 100);
  EXPECT_EQ(line.summary.surface.z_nm(92, 1), 0);
  EXPECT_NEAR(line.summary.deviation_nm(35, 0), 2, 1e-9);
  EXPECT_EQ(line.summary.fitted(35, 0), 2);
}

TEST(ProfileSurface, GoesOnByThePitchWhereTheImageEnds) {
  Line line;
  line.summary.pitch_nm = 140;
  add_surface(line.image, line.summary);
  EXPECT_EQ(line.summary.surface.z_nm(88, 1), 0);
  EXPECT_EQ(line.summary.surface.z_nm(92, 1), 100);
  line.summary.measured_pitch_nm = Measured{150, 0.2};  // what the fit tells counts
  add_surface(line.image, line.summary);
  EXPECT_EQ(line.summary.surface.z_nm(92, 1), 0);
}

}  // namespace
}  // namespace surf::workflow
