// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/surface_view.h"

#include "specimens.h"
#include "statistics.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

TEST(SurfaceView, ShowsHeightNormalAndMaterial) {
  Specimen specimen;
  specimen.materials = {io::find_material("Si", "test"), io::find_material("Au", "test")};
  specimen.bodies.push_back({"box", make_box({-20, -20, 0}, {20, 20, 30}), 1});
  specimen.bodies.push_back(
      {"wedge",
       {{{30, -20, 0}, {50, -20, 0}, {50, -20, 20}, {30, 20, 0}, {50, 20, 0}, {50, 20, 20}},
        {{0, 1, 2}, {3, 5, 4}, {0, 2, 5}, {0, 5, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}}},
       0});
  Scan scan = test::square_scan(110, 11);
  const Image v = surface_view(Scene(specimen, {}, scan), 2);
  const auto at = [&](const char* channel, int x, int y) {
    return static_cast<double>(v.find(channel)->values(x, y));
  };
  EXPECT_EQ(at("z_nm", 5, 5), 30);
  EXPECT_EQ(at("material", 5, 5), 2);
  EXPECT_EQ(at("normal.z", 5, 5), 1);
  EXPECT_EQ(at("valid", 5, 5), 1);
  EXPECT_EQ(at("valid", 0, 0), 0);
  EXPECT_EQ(at("material", 0, 0), 0);
  // x = 40: halfway up the slope of 45 degrees that faces -x.
  EXPECT_NEAR(at("z_nm", 9, 5), 10, 1e-5);
  EXPECT_NEAR(at("normal.x", 9, 5), -std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(at("normal.z", 9, 5), std::sqrt(0.5), 1e-6);
  EXPECT_EQ(at("material", 9, 5), 1);
}

TEST(SurfaceView, FollowsATiltedBeam) {
  Specimen specimen = test::flat("Si");
  specimen.bodies.push_back({"box", test::pillar(40, 60), 0});
  Beam beam;
  beam.tilt_deg = 45;  // towards +x: the beam meets the face at x = -20
  Scan scan = test::square_scan(100, 50);
  scan.center_z_nm = 30;
  const Image v = surface_view(Scene(specimen, beam, scan));
  int front = 0, back = 0;
  for (const float n : v.find("normal.x")->values.data()) {
    front += n < -0.9;
    back += n > 0.9;
  }
  EXPECT_GT(front, 100);
  EXPECT_EQ(back, 0);
}

}  // namespace surf::mc
