// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_frame.h"

#include <gmock/gmock.h>

#include <cmath>

namespace surf::workflow {
namespace {

using testing::ElementsAre;

TEST(SemFrame, InterpolatesWhereTheMapSays) {
  HeightField plane;
  plane.z_nm = Grid<double>(10, 8);
  plane.pitch_x_nm = 2, plane.pitch_y_nm = 3, plane.origin_x_nm = 5;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 10; ++x) plane.z_nm(x, y) = 0.5 * plane.x_nm(x) - 0.25 * plane.y_nm(y);
  PlacedImage sem;
  sem.values = Grid<double>(30, 30);
  const Affine map{0.6, -0.2, 6, 0.3, 0.5, 1};
  const SurfaceUnderSem under = surface_under_sem(plane, sem, map);
  int known = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      const Point2 p = map({double(x), double(y)});
      const bool inside =
          p.x > 5 - 1e-9 && p.x < 23 + 1e-9 && p.y > -1e-9 && p.y < 21 + 1e-9;  // but for rounding
      EXPECT_EQ(under.known(x, y) != 0, inside);
      if (!inside) continue;
      ++known;
      EXPECT_NEAR(under.surface.z_nm(x, y), 0.5 * p.x - 0.25 * p.y, 1e-12);
    }
  EXPECT_DOUBLE_EQ(under.overlap, known / 900.0);
}

TEST(SemFrame, HolesTakeTheHeightOfTheirNeighbours) {
  HeightField field;
  field.z_nm = Grid<double>(3, 2);
  field.z_nm.data() = {1, 99, 3, 1, 99, 3};
  field.valid = Mask(3, 2);
  field.valid.data() = {1, 0, 1, 1, 0, 1};
  const HeightField whole = with_holes_filled(field);
  EXPECT_THAT(whole.z_nm.data(), ElementsAre(1, 2, 3, 1, 2, 3));
  EXPECT_TRUE(whole.valid.empty());
}

}  // namespace
}  // namespace surf::workflow
