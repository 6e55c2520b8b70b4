// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/gun.h"

#include <cmath>

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"
#include "surf/mc/geometry/surface_view.h"

namespace surf::mc {

namespace {

// Where a beam goes through the plane z = height.
Vec3 at_height(const Gun::Start& s, double height_nm) {
  return s.position + s.direction * ((height_nm - s.position.z) / s.direction.z);
}

}  // namespace

TEST(Gun, ConvergesToItsFocusAndFillsTheConeEvenly) {
  Beam beam;
  beam.convergence_deg = 2;
  beam.focus_nm = 50;
  const Scan scan = test::square_scan(10, 1);
  const Gun gun(beam, scan, 100);
  RandomStream random(1, 0, 0);
  std::vector<std::int64_t> rings(20);
  const double rim = 200 * std::tan(2 * 0.017453292519943295);
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Gun::Start s = gun.primary(0, 0, random);
    EXPECT_GT(s.position.z, 100);
    EXPECT_NEAR(length(s.direction), 1, 1e-12);
    const Vec3 focus = at_height(s, 50);
    EXPECT_NEAR(std::hypot(focus.x, focus.y), 0, 1e-9);
    const Vec3 below = at_height(s, -150);
    const double share = (below.x * below.x + below.y * below.y) / (rim * rim);
    ASSERT_LE(share, 1 + 1e-9);
    ++rings[static_cast<std::size_t>(std::min(19.0, 20 * share))];
  }
  test::expect_distributed(rings, std::vector<double>(20, n / 20.0));
}

TEST(Gun, PerspectiveComesFromOnePoint) {
  Beam beam;
  beam.tilt_deg = 30;
  beam.working_distance_nm = 1000;
  Scan scan = test::square_scan(400, 5);
  scan.center_z_nm = 20;
  const Gun gun(beam, scan, 40);
  const Vec3 lens = Vec3{0, 0, 20} - direction(beam) * 1000;
  for (const int x : {0, 2, 4})
    for (const int y : {0, 3}) {
      const Gun::Start s = gun.middle(x, y);
      const Vec3 to_lens = lens - s.position;
      EXPECT_NEAR(length(cross(to_lens, s.direction)), 0, 1e-9);
      EXPECT_LT(dot(to_lens, s.direction), 0) << "the lens is above the start";
    }
  EXPECT_NEAR(dot(gun.middle(2, 2).direction, direction(beam)), 1, 1e-12);
}

TEST(Gun, RefusesBeamsFromBelowOrFromTheSide) {
  Beam beam;
  beam.working_distance_nm = 50;
  EXPECT_THROW(Gun(beam, test::square_scan(10, 1), 100), UsageError);
  beam.working_distance_nm = 200;
  EXPECT_NO_THROW(Gun(beam, test::square_scan(10, 1), 100));
  beam = {};
  beam.tilt_deg = 85;
  beam.convergence_deg = 6;
  EXPECT_THROW(Gun(beam, test::square_scan(10, 1), 100), UsageError);
  beam.convergence_deg = 0;
  beam.tilt_deg = 89.9;
  EXPECT_NO_THROW(Gun(beam, test::square_scan(10, 1), 100));
  beam.tilt_deg = 89.95;
  EXPECT_THROW(Gun(beam, test::square_scan(10, 1), 100), UsageError);
}

// With perspective the walls of a box that face outward are seen; without they are not.
TEST(Perspective, MagnifiesWhatIsNearer) {
  Specimen specimen = test::flat("Si");
  specimen.bodies.push_back({"box", test::pillar(100, 400), 0});
  Scan scan = test::square_scan(300, 60);
  const auto high = [&](const Beam& beam) {
    const Image view = surface_view(Scene(specimen, beam, scan));
    int count = 0;
    for (const float z : view.find("z_nm")->values.data()) count += z > 399;
    return count;
  };
  Beam near;
  near.working_distance_nm = 1000;
  EXPECT_EQ(high({}), 20 * 20);
  // The top is at 600 of 1000 nm from the lens: 100 / 0.6 = 167 nm wide in the scan plane.
  EXPECT_NEAR(high(near), std::pow(167.0 / 5, 2), 4 * 34);
}

}  // namespace surf::mc
