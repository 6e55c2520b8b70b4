// SPDX-License-Identifier: GPL-3.0-or-later
// Replay gives what direct simulation gives: in every detector, in mean, mean square and spectra,
// over independently drawn libraries.
#include <cmath>

#include "mesh_test.h"
#include "replay/replay_test.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf::mc {

namespace {

using test::row_of_pixels;

std::vector<Detector> all_kinds(const Beam& beam) {
  std::vector<Detector> detectors = default_detectors();
  const auto add = [&](const std::string& text) {
    for (const Detector& d : parse_detectors(text, "test")) detectors.push_back(d);
  };
  for (const char* name : {"SE1", "SE2", "quadrants", "annular", "in-lens", "side"}) add(name);
  const int e = static_cast<int>(beam.energy_ev);
  add("loss:name=loss,energy=" + std::to_string(e * 7 / 10) + "eV..,side=up");
  add("all:name=down,side=down");
  return detectors;
}

struct Setup {
  Specimen specimen;
  Beam beam;
  Scan scan;
  Physics physics = {};
};

// `primaries` of each pixel, by each method; those replayed over so many libraries of one page.
void expect_same(const Setup& setup, int primaries, int libraries = 4) {
  const Scene scene(setup.specimen, setup.beam, setup.scan, setup.physics);
  SimulationOptions options;
  options.detectors = all_kinds(setup.beam);
  options.spectra = true;
  options.budget = ElectronsPerPixel{1 << 20};
  options.seed = 1;
  test::SceneSample direct;
  const auto worker = make_direct_worker(scene.impl(), options);
  test::add_blocks(direct, *worker, setup.scan, primaries / 40, 40);

  test::SceneSample replay;
  for (int i = 0; i < libraries; ++i) {
    options.seed = 100 + static_cast<std::uint64_t>(i);
    const Libraries drawn = test::make_libraries(scene, options.seed, 1);
    // Surroundings are looked for from 8 primaries on: with and without.
    const int size = i % 2 == 0 ? 50 : 5;
    const auto replayer = make_replay_worker(scene.impl(), options, drawn);
    test::add_blocks(replay, *replayer, setup.scan, primaries / libraries / size, size);
  }
  test::expect_balanced(direct.balance);
  test::expect_balanced(replay.balance);
  // Cascades of electrons that lose in events cannot be joined: those that enter another material
  // go on directly.
  const bool joins = !is_dielectric(setup.physics) || setup.specimen.materials.size() == 1;
  EXPECT_EQ(replay.balance.handed_over == 0, joins);
  test::expect_same_sample(direct, replay, options.detectors);
}

Beam beam_of(double energy_ev, double tilt_deg = 0, double azimuth_deg = 0) {
  Beam beam;
  beam.energy_ev = energy_ev;
  beam.tilt_deg = tilt_deg;
  beam.azimuth_deg = azimuth_deg;
  return beam;
}

Specimen field(const HeightField& f, Edge edge = Edge::flat) {
  Specimen s = test::flat("Si");
  s.substrate.reset();
  s.height_field = HeightFieldBody{"field", f, 0, edge};
  return s;
}

Specimen mesa() { return field(make_mesa({240, 240, 8}, 60, 60, 8)); }

// A body on the substrate, of gold where `gold`.
Specimen with_body(const TriangleMesh& mesh, bool gold = false) {
  Specimen s = test::flat("Si");
  if (gold) s.materials.push_back(io::find_material("Au", "test"));
  s.bodies.push_back({"body", mesh, gold ? 1 : 0});
  return s;
}

Physics in_events(const char* more = "") {
  Physics physics;
  parse_physics(std::string("inelastic=dielectric,") + more, physics);
  return physics;
}

}  // namespace

TEST(ReplaySameness, OnAPlaneAtEveryEnergy) {
  expect_same({test::flat("Si"), beam_of(500), row_of_pixels(0, 1, 1)}, 12000, 6);
  expect_same({test::flat("Si"), beam_of(3000), row_of_pixels(0, 1, 1)}, 2000, 1);
  expect_same({test::flat("Si"), beam_of(10000), row_of_pixels(0, 1, 1)}, 800, 1);
}

TEST(ReplaySameness, UnderEveryBarrier) {
  for (const BarrierModel barrier : {BarrierModel::classical, BarrierModel::off}) {
    Physics physics;
    physics.barrier = barrier;
    expect_same({mesa(), beam_of(700), row_of_pixels(20, 14, 3), physics}, 3200, 2);
  }
}

TEST(ReplaySameness, WithoutSecondaries) {
  Physics physics;
  physics.secondaries = false;
  physics.elastic = ElasticModel::browning;
  expect_same({mesa(), beam_of(3000), row_of_pixels(20, 14, 3), physics}, 6000);
}

TEST(ReplaySameness, OnAMesa) {
  // Its top, its edge, its foot, and beside.
  expect_same({mesa(), beam_of(1000), row_of_pixels(0, 14, 4)}, 4000);
}

TEST(ReplaySameness, OnAMesaWhoseWidePixelsShareASurface) {
  expect_same({mesa(), beam_of(1000), row_of_pixels(15, 10, 4)}, 4000);
}

TEST(ReplaySameness, InATrench) {
  expect_same({field(make_trench({240, 240, 8}, 80, 40, 8), Edge::mirror), beam_of(1000),
               row_of_pixels(0, 13, 4)},
              3200, 2);
}

TEST(ReplaySameness, OnASphereOnASubstrate) {
  expect_same({with_body(make_sphere({0, 0, 30}, 30, 3)), beam_of(1000), row_of_pixels(0, 11, 4)},
              3200, 2);
}

TEST(ReplaySameness, UnderAnOverhang) {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"stem", make_box({-15, -15, 0}, {15, 15, 30}), 0});
  s.bodies.push_back({"cap", make_box({-40, -40, 30}, {40, 40, 45}), 0});
  expect_same({s, beam_of(1000, 50), row_of_pixels(-34, 21, 4)}, 3200, 2);
}

TEST(ReplaySameness, InAThinMembrane) {
  Specimen s = test::flat("Si");
  s.substrate.reset();
  s.bodies.push_back({"membrane", make_box({-4000, -4000, 0}, {4000, 4000, 12}), 0});
  expect_same({s, beam_of(1500), row_of_pixels(0, 100, 1)}, 4000, 2);
}

TEST(ReplaySameness, OfAGoldSphereOnSilicon) {
  expect_same(
      {with_body(make_sphere({0, 0, 15}, 15, 3), true), beam_of(1500), row_of_pixels(0, 8, 3)},
      2000, 1);
}

TEST(ReplaySameness, OfAGoldFilmOnSilicon) {
  expect_same({with_body(make_box({-3000, -3000, 0}, {3000, 3000, 4}), true), beam_of(1000),
               row_of_pixels(0, 100, 1)},
              4000, 2);
}

TEST(ReplaySameness, UnderATiltedBeam) {
  expect_same({mesa(), beam_of(1000, 40, 30), row_of_pixels(-48, 32, 4)}, 3200, 2);
}

TEST(ReplaySameness, UnderASpotAConeAndPerspective) {
  Beam beam = beam_of(1000);
  beam.spot_nm = 6;
  beam.convergence_deg = 2;
  beam.focus_nm = 100;
  expect_same({mesa(), beam, row_of_pixels(20, 14, 3)}, 3200, 2);
  beam = beam_of(1000);
  beam.working_distance_nm = 200;
  expect_same({mesa(), beam, row_of_pixels(0, 28, 3)}, 3200, 2);
}

// Farther away than any electron gets through matter, but not through vacuum: electrons from the
// floor come back in through a wall of the same body.
TEST(ReplaySameness, BesideAFarWallOfTheSameBody) {
  expect_same(
      {field(make_trench({600, 600, 10}, 300, 60, 10)), beam_of(300), row_of_pixels(0, 1, 1)},
      48000, 12);
}

// Most primaries of a wide spot come down elsewhere than its middle.
TEST(ReplaySameness, UnderASpotWiderThanAnyRange) {
  Beam beam = beam_of(300);
  beam.spot_nm = 40;
  expect_same({mesa(), beam, row_of_pixels(60, 1, 1)}, 8000);
}

TEST(ReplaySameness, OfLossesInEventsOnAPlane) {
  expect_same({test::flat("Si"), beam_of(1000), row_of_pixels(0, 1, 1), in_events()}, 8000);
  expect_same({test::flat("Au"), beam_of(5000), row_of_pixels(0, 1, 1), in_events("auger=on")},
              1600, 1);
}

TEST(ReplaySameness, OfLossesInEventsOnAMesa) {
  expect_same({mesa(), beam_of(1000), row_of_pixels(0, 14, 4), in_events()}, 4000);
  expect_same({mesa(), beam_of(1000, 40, 30), row_of_pixels(-48, 32, 4),
               in_events("inelastic-model=single-pole")},
              3200, 2);
}

TEST(ReplaySameness, OfLossesInEventsInATrench) {
  expect_same({field(make_trench({240, 240, 8}, 80, 40, 8), Edge::mirror), beam_of(1000),
               row_of_pixels(0, 13, 4), in_events()},
              3200, 2);
}

TEST(ReplaySameness, OfLossesInEventsUnderAnOverhang) {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"stem", make_box({-15, -15, 0}, {15, 15, 30}), 0});
  s.bodies.push_back({"cap", make_box({-40, -40, 30}, {40, 40, 45}), 0});
  expect_same({s, beam_of(1000, 50), row_of_pixels(-34, 21, 4), in_events()}, 3200, 2);
}

TEST(ReplaySameness, OfLossesInEventsWithAGoldFilm) {
  expect_same({with_body(make_box({-3000, -3000, 0}, {3000, 3000, 4}), true), beam_of(1000),
               row_of_pixels(0, 100, 1), in_events()},
              4000, 2);
}

TEST(ReplaySameness, OfLossesInEventsWithAnInsulatorOnAMetal) {
  Specimen s = test::flat("Al");
  s.materials.push_back(io::find_material("SiO2", "test"));
  s.bodies.push_back({"oxide", make_sphere({0, 0, 12}, 12, 3), 1});
  expect_same({s, beam_of(1000), row_of_pixels(0, 7, 3), in_events()}, 2000, 1);
}

}  // namespace surf::mc
