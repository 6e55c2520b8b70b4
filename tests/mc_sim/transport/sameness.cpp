// SPDX-License-Identifier: GPL-3.0-or-later
// What must not change an image, and honest standard errors.
#include <cmath>

#include "specimens.h"
#include "statistics.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using test::square_scan;

// A chiral specimen: an L of two boxes on a plane.
Specimen letter_l() {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"long", make_box({-30, -10, 0}, {30, 10, 40}), 0});
  s.bodies.push_back({"short", make_box({10, 10, 0}, {30, 30, 20}), 0});
  return s;
}

// Compares two results pixel by pixel with their own standard errors; `map` gives the pixel of
// `b` for one of `a`.
template <class Map>
void expect_same(const SimulationResult& a, const SimulationResult& b, const Map& map) {
  const int w = a.pixels.width(), h = a.pixels.height();
  const std::size_t comparisons = 2 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
  double squares = 0;
  int cells = 0;
  const auto compare = [&](const Estimate& x, const Estimate& y, std::int64_t counts) {
    if (counts < 50) return;  // too few for the normal approximation
    const double z = (x.mean - y.mean) / std::hypot(x.standard_error, y.standard_error);
    EXPECT_LT(std::fabs(z), test::z_limit(2 * comparisons));
    squares += z * z;
    ++cells;
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto [bx, by] = map(x, y);
      for (const std::size_t d : {test::se, test::bse})
        compare(a.yield(d, x, y), b.yield(d, bx, by),
                a.counts[d](x, y).sum + b.counts[d](bx, by).sum);
    }
  ASSERT_GT(cells, 20);
  // The z-scores are standard normal: neither too large nor too small.
  EXPECT_LT(std::fabs(test::chi_squared_z(squares, cells)), test::z_limit(2));
}

const auto same_pixel = [](int x, int y) { return std::pair(x, y); };

void turn(Specimen& s) {
  for (Body& b : s.bodies)
    for (Vec3& v : b.mesh.vertices_nm) v = {-v.y, v.x, v.z};
}

}  // namespace

TEST(Sameness, ASpecimenTurnedBy90DegreesGivesTheTurnedImage) {
  const Scan scan = square_scan(84, 12);
  const auto a = test::simulate(letter_l(), {}, scan, 600);
  Specimen turned = letter_l();
  turn(turned);
  const auto b = test::simulate(turned, {}, scan, 600, {}, 2);
  expect_same(a, b, [&](int x, int y) { return std::pair(scan.width - 1 - y, x); });
}

TEST(Sameness, AzimuthTurnsWithTheSpecimen) {
  const Scan scan = square_scan(84, 10);
  Beam beam;
  beam.tilt_deg = 40;
  const auto a = test::simulate(letter_l(), beam, scan, 600);
  Specimen turned = letter_l();
  turn(turned);
  beam.azimuth_deg = 90;
  const auto b = test::simulate(turned, beam, scan, 600, {}, 2);
  expect_same(a, b, [&](int x, int y) { return std::pair(scan.width - 1 - y, x); });
}

TEST(Sameness, MovingByAMillimetreChangesNothing) {
  Scan scan = square_scan(84, 12);
  const auto a = test::simulate(letter_l(), {}, scan, 600);
  Specimen moved = letter_l();
  const Vec3 by{1e6, -1e6, 1e6};
  for (Body& b : moved.bodies)
    for (Vec3& v : b.mesh.vertices_nm) v += by;
  moved.substrate->top_nm += by.z;
  scan.center_x_nm += by.x;
  scan.center_y_nm += by.y;
  scan.center_z_nm += by.z;
  const auto b = test::simulate(moved, {}, scan, 600, {}, 2);
  expect_same(a, b, same_pixel);
  EXPECT_EQ(b.balance.total_lost(), 0);
}

TEST(Sameness, SplittingTrianglesChangesNothing) {
  const Scan scan = square_scan(84, 12);
  Specimen coarse = test::flat("Si"), fine = test::flat("Si");
  coarse.bodies.push_back({"box", make_box({-30, -20, 0}, {30, 20, 40}), 0});
  fine.bodies.push_back({"box", make_box({-30, -20, 0}, {30, 20, 40}, 17), 0});
  expect_same(test::simulate(coarse, {}, scan, 600), test::simulate(fine, {}, scan, 600, {}, 2),
              same_pixel);
}

TEST(Sameness, AMeshAndItsHeightFieldAgree) {
  const Scan scan = square_scan(90, 12);
  const HeightField field = make_mesa({200, 200, 10}, 50, 40, 10);
  // Electrons that fly low meet the plane far out: the solid has to go on there.
  const HeightField wide = extend_height_field(field, 1500, 1500, Edge::flat);
  Specimen height = test::flat("Si"), mesh = test::flat("Si");
  height.substrate.reset();
  height.height_field = HeightFieldBody{"mesa", field, 0, Edge::flat};
  mesh.substrate.reset();
  mesh.bodies.push_back({"mesa", height_field_solid(wide, -2000), 0});
  expect_same(test::simulate(height, {}, scan, 600), test::simulate(mesh, {}, scan, 600, {}, 2),
              same_pixel);
}

TEST(Sameness, DroppingWhatCannotReachASurfaceChangesNothing) {
  // An observer has every track followed to its end.
  class Nobody final : public Observer {
  } nobody;
  const Scan scan = square_scan(84, 6);
  const Scene scene(letter_l(), {}, scan);
  SimulationResult full;
  const UnitTally unit = simulate_unit(scene, test::seeded(2), {0, 0, 6, 6, 0, 400}, &nobody);
  full.detectors = default_detectors();
  full.counts.assign(unit.counts.begin(), unit.counts.end());
  full.pixels = unit.pixels;
  EXPECT_EQ(unit.balance.dropped, 0);
  const auto quick = test::simulate(letter_l(), {}, scan, 400);
  EXPECT_GT(quick.balance.dropped, 0);
  expect_same(quick, full, same_pixel);
}

TEST(Sameness, TheDistanceBoundsChangeNothing) {
  const Scan scan = square_scan(84, 8);
  SimulationOptions options;
  options.budget = ElectronsPerPixel{400};
  const auto with = simulate(Scene(letter_l(), {}, scan), options);
  options.seed = 2;
  const auto without = simulate(Scene(letter_l(), {}, scan, {}, {0}), options);
  EXPECT_LT(static_cast<double>(with.balance.rays),
            0.8 * static_cast<double>(without.balance.rays));
  expect_same(with, without, same_pixel);
}

TEST(Sameness, AnOpenSheetIsTheTopOfAHalfSpace) {
  const HeightField mesa = make_mesa({120, 120, 4}, 40, 40, 8);
  const Scan scan = square_scan(140, 10);  // beyond its rim, too
  Specimen field = test::flat("Si"), sheet = test::flat("Si");
  field.substrate.reset();
  sheet.substrate.reset();
  field.height_field = HeightFieldBody{"mesa", mesa, 0, Edge::flat};
  sheet.bodies.push_back({"mesa", height_field_sheet(mesa), 0});
  expect_same(test::simulate(field, {}, scan, 300), test::simulate(sheet, {}, scan, 300, {}, 2),
              same_pixel);

  // A box without its bottom, turned inside out for good measure, on the plane that it makes.
  Specimen box = test::flat("Si"), open_box = box;
  box.bodies.push_back({"box", test::pillar(60, 40), 0});
  open_box.substrate.reset();
  TriangleMesh open = test::pillar(60, 40);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return open.vertices_nm[t[0]].z + open.vertices_nm[t[1]].z + open.vertices_nm[t[2]].z == 0;
  });
  ASSERT_EQ(open.triangles.size(), 10u);
  for (Triangle& t : open.triangles) std::swap(t[0], t[1]);
  open_box.bodies.push_back({"open box", open, 0});
  const auto a = test::simulate(open_box, {}, scan, 300);
  EXPECT_EQ(a.balance.total_lost(), 0);
  expect_same(a, test::simulate(box, {}, scan, 300, {}, 2), same_pixel);
}

TEST(Sameness, SameNumbersForAnyThreadsAndTiles) {
  const Scan scan = square_scan(84, 9);
  const Scene scene(letter_l(), {}, scan);
  std::vector<SimulationResult> results;
  for (const int threads : {1, 2, 7})
    for (const int tile : {1, 13, 1024}) {
      SimulationOptions options;
      options.budget = ElectronsPerPixel{20};
      options.threads = threads;
      options.tile_pixels = tile;
      results.push_back(simulate(scene, options));
    }
  for (const SimulationResult& r : results) {
    EXPECT_EQ(make_image(r, scan).find("SE.stderr")->values,
              make_image(results[0], scan).find("SE.stderr")->values);
    EXPECT_EQ(make_image(r, scan).find("BSE")->values,
              make_image(results[0], scan).find("BSE")->values);
    EXPECT_EQ(r.balance.deposited_energy.ev(), results[0].balance.deposited_energy.ev());
    EXPECT_EQ(r.balance.rays, results[0].balance.rays);
  }
}

TEST(Sameness, ElectronRangesAddUp) {
  const Scan scan = square_scan(84, 4);
  const Scene scene(letter_l(), {}, scan);
  UnitTally whole = simulate_unit(scene, test::seeded(1), {0, 0, 4, 4, 0, 30});
  UnitTally first = simulate_unit(scene, test::seeded(1), {0, 0, 4, 4, 0, 11});
  const UnitTally second = simulate_unit(scene, test::seeded(1), {0, 0, 4, 4, 11, 19});
  first.balance += second.balance;
  EXPECT_EQ(first.balance.se, whole.balance.se);
  EXPECT_EQ(first.balance.escaped_energy.ev(), whole.balance.escaped_energy.ev());
  for (std::size_t i = 0; i < 16; ++i) {
    first.pixels.data()[i] += second.pixels.data()[i];
    EXPECT_EQ(first.pixels.data()[i].hits, whole.pixels.data()[i].hits);
    for (const std::size_t d : {test::se, test::bse}) {
      first.counts[d].data()[i] += second.counts[d].data()[i];
      EXPECT_EQ(first.counts[d].data()[i], whole.counts[d].data()[i]);
    }
  }
}

// Repeated runs scatter as their standard errors say.
TEST(StandardError, IsHonest) {
  const Scan scan = square_scan(84, 6);
  std::vector<SimulationResult> runs;
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    runs.push_back(test::simulate(letter_l(), {}, scan, 100, {}, seed));
  double squares = 0;
  int cells = 0;
  for (std::size_t i = 0; i < 36; ++i) {
    Counts all;
    for (const auto& r : runs) all += r.counts[test::se].data()[i];
    const Estimate truth = estimate(3000, all);
    for (const auto& r : runs) {
      const std::int64_t counts = r.counts[test::se].data()[i].sum;
      if (counts < 25) continue;
      // Against the pooled error: a run's own error is correlated with its mean.
      const double z = (static_cast<double>(counts) / 100 - truth.mean) /
                       (truth.standard_error * std::sqrt(30.0));
      squares += z * z;
      ++cells;
    }
  }
  ASSERT_GT(cells, 500);
  // The pooled mean takes one degree of freedom in thirty.
  EXPECT_LT(std::fabs(test::chi_squared_z(squares, cells * 29.0 / 30)), test::z_limit());
}

TEST(Spot, BlursAnEdge) {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"box", make_box({0, -100, 0}, {100, 100, 60}), 0});
  const Scan scan = square_scan(40, 20);
  Beam sharp, wide;
  wide.spot_nm = 6;
  const auto edge = [&](const Beam& beam) {
    const auto r = test::simulate(s, beam, scan, 100);
    double most = 0;
    for (int x = 0; x < 20; ++x) {
      double column = 0;
      for (int y = 0; y < 20; ++y) column += static_cast<double>(r.counts[test::se](x, y).sum);
      most = std::max(most, column);
    }
    return most;
  };
  EXPECT_GT(edge(sharp), 1.1 * edge(wide));
}

}  // namespace surf::mc
