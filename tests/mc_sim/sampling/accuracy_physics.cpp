// SPDX-License-Identifier: GPL-3.0-or-later
// Spending electrons where an accuracy needs them: unbiased, with honest standard errors, and as
// accurate as was asked for. Against direct simulation, over independently drawn libraries.
#include <cmath>

#include "replay/replay_test.h"
#include "sampling/adaptive_sampling.h"

namespace surf::mc {

namespace {

constexpr double accuracy = 0.1;
constexpr int seeds = 30;

// The same for all tests: one page for each seed.
test::SmallLibraries& libraries() {
  static test::SmallLibraries made(1);
  return made;
}

struct Spent {
  test::Sample
      deviation;  ///< per seed: mean over pixels and detectors, in standard errors asked for
  int inside = 0, estimates = 0;    ///< within 1.96 standard errors of the reference
  int differences = 0, planes = 0;  ///< by model
};

enum class How { with_control, without_control, direct };

SimulationOptions spending(How how) {
  SimulationOptions options;
  options.method = how == How::direct ? Method::direct : Method::replay;
  options.budget = Accuracy{accuracy};
  options.planar_control = how == How::with_control;
  options.threads = 1;
  return options;
}

// Per detector and pixel.
std::vector<std::vector<Estimate>> reference(const Scene& scene, std::int64_t electrons) {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{electrons};
  options.seed = 7;
  const SimulationResult result = simulate(scene, options);
  std::vector<std::vector<Estimate>> out(result.counts.size());
  for (std::size_t d = 0; d < out.size(); ++d)
    for (int x = 0; x < scene.scan().width; ++x) out[d].push_back(result.yield(d, x, 0));
  return out;
}

Spent spend(const Scene& scene, How how, const std::vector<std::vector<Estimate>>& truth) {
  Spent spent;
  SimulationOptions options = spending(how);
  for (int seed = 1; seed <= seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    SimulationResult r = simulate(scene, options, {.libraries = &libraries()});
    if (how != How::direct) r.library_cascades = CascadeLibrary::page_cascades;
    EXPECT_EQ(r.balance.total_lost(), 0);
    double sum = 0;
    int terms = 0;
    for (std::size_t d = 0; d < truth.size(); ++d)
      for (int x = 0; x < scene.scan().width; ++x) {
        const Estimate e = r.yield(d, x, 0);
        const Estimate& t = truth[d][static_cast<std::size_t>(x)];
        const double asked = std::max(accuracy * e.mean, floor_of(options.budget));
        const double off = e.mean - t.mean;
        sum += off / asked;
        ++terms;
        spent.inside += std::fabs(off) < 1.96 * std::hypot(e.standard_error, t.standard_error);
        ++spent.estimates;
      }
    for (const PixelTally& p : r.pixels.data()) {
      spent.differences += p.model == PixelModel::difference;
      spent.planes += p.model == PixelModel::plane;
    }
    spent.deviation.add(sum / terms);
  }
  return spent;
}

void expect_well_spent(const Specimen& specimen, const Scan& scan, bool planes = false,
                       const Physics& physics = {}) {
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(specimen, beam, scan, physics);
  const auto truth = reference(scene, 40000);
  // The reference's own share, were all its errors alike.
  double known = 0;
  int terms = 0;
  for (const auto& detector : truth)
    for (const Estimate& e : detector) {
      known += std::pow(e.standard_error / (accuracy * e.mean), 2);
      ++terms;
    }
  known = std::sqrt(known) / terms;
  for (const How how : {How::with_control, How::without_control, How::direct}) {
    SCOPED_TRACE(how == How::with_control ? "with control"
                 : how == How::direct     ? "direct"
                                          : "without control");
    const bool control = how == How::with_control;
    const Spent s = spend(scene, how, truth);
    test::expect_mean(s.deviation.mean(), std::hypot(s.deviation.standard_error(), known), 0, 12);
    const double share = static_cast<double>(s.inside) / s.estimates;
    const double scatter = std::sqrt(0.95 * 0.05 / s.estimates);
    EXPECT_NEAR(share, 0.95, test::z_limit(12) * scatter);
    if (control) EXPECT_GT(s.differences + s.planes, 0);
    else EXPECT_EQ(s.differences + s.planes, 0);
    EXPECT_EQ(s.planes > 0, planes && control);
  }
}

Specimen field(const HeightField& f) {
  Specimen s = test::flat("Si");
  s.substrate.reset();
  s.height_field = HeightFieldBody{"field", f, 0, Edge::flat};
  return s;
}

}  // namespace

TEST(Accuracy, OnAPlane) {
  expect_well_spent(test::flat("Si"), test::row_of_pixels(0, 5, 1), true);
}

TEST(Accuracy, BesideAWallsFoot) {
  // From its top over the wall to where nothing but rare electrons tell of it.
  expect_well_spent(field(make_mesa({240, 240, 8}, 60, 60, 8)), test::row_of_pixels(20, 14, 5));
}

TEST(Accuracy, WithLossesInEvents) {
  Physics physics;
  parse_physics("inelastic=dielectric", physics);
  expect_well_spent(field(make_mesa({240, 240, 8}, 60, 60, 8)), test::row_of_pixels(20, 14, 5),
                    false, physics);
}

TEST(Accuracy, BesideAnIsolatedEdge) {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"terrace", make_box({0, -500, 0}, {500, 500, 30}), 0});
  // Two beside it on top, then planes as far as electrons get.
  expect_well_spent(s, test::row_of_pixels(4, 6, 5), true);
}

TEST(Accuracy, OnARoughSurface) {
  expect_well_spent(field(make_rough({200, 200, 4}, 4, 15, 3)), test::row_of_pixels(-30, 12, 5));
}

// With libraries as large as they are made for that accuracy.
TEST(Accuracy, IsReached) {
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(field(make_mesa({240, 240, 8}, 60, 60, 8)), beam, test::square_scan(120, 9));
  for (const How how : {How::with_control, How::without_control, How::direct}) {
    const SimulationOptions options = spending(how);
    const SimulationResult r = simulate(scene, options);
    if (how == How::direct) EXPECT_EQ(r.library_cascades, 0u);
    else EXPECT_GE(r.library_cascades, 10000u);
    int above = 0;
    for (std::size_t d = 0; d < r.counts.size(); ++d)
      for (int i = 0; i < 81; ++i) {
        const Estimate e = r.yield(d, i % 9, i / 9);
        const double asked = std::max(accuracy * e.mean, floor_of(options.budget));
        above += e.standard_error > asked;
        EXPECT_LT(e.standard_error, 1.15 * asked);
      }
    EXPECT_LE(above, 8);  // of 162
  }
}

// Threads and the tiles' order change nothing; where the beam meets nothing no electrons are
// wasted.
TEST(Accuracy, DirectIsTheSameForAnyThreads) {
  Specimen s = test::flat("Si");
  s.substrate.reset();
  s.bodies.push_back({"post", make_box({-30, -30, 0}, {30, 30, 30}), 0});
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(s, beam, test::square_scan(200, 40));
  SimulationOptions options = spending(How::direct);
  options.budget = Accuracy{0.3};
  const SimulationResult one = simulate(scene, options);
  options.threads = 3;
  const SimulationResult three = simulate(scene, options);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(one.counts[0](x, y), three.counts[0](x, y));
      EXPECT_EQ(one.pixels(x, y).primaries, three.pixels(x, y).primaries);
    }
  EXPECT_EQ(one.pixels(0, 0).model, PixelModel::none);
  EXPECT_EQ(one.pixels(0, 0).primaries, fewest_primaries);
  EXPECT_EQ(one.pixels(20, 20).model, PixelModel::direct);
}

// Without a floor a pixel that gives nothing does not go on for ever.
TEST(Accuracy, DirectEndsWithoutAFloor) {
  Physics physics;
  physics.secondaries = false;
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(test::flat("Si"), beam, test::row_of_pixels(0, 2, 1), physics);
  SimulationOptions options = spending(How::direct);
  options.budget = Accuracy{0.5, 0};
  options.detectors.resize(1);  // SE: none leave
  options.detectors[0].max_energy_ev = 1e-6;
  const SimulationResult r = simulate(scene, options);
  EXPECT_LE(r.pixels(0, 0).primaries, 10000);
}

// No standard error below the floor is worked for.
TEST(Accuracy, StopsAtItsFloor) {
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(field(make_mesa({240, 240, 8}, 60, 60, 8)), beam,
                    test::row_of_pixels(20, 14, 5));
  SimulationOptions options = spending(How::with_control);
  const auto primaries = [&](double floor) {
    options.budget = Accuracy{accuracy, floor};
    const SimulationResult r = simulate(scene, options, {.libraries = &libraries()});
    std::int64_t sum = 0;
    for (const PixelTally& p : r.pixels.data()) sum += p.primaries;
    for (int x = 0; x < scene.scan().width; ++x)
      for (std::size_t d = 0; d < r.counts.size(); ++d)
        EXPECT_LT(r.yield(d, x, 0).standard_error,
                  1.15 * std::max(floor, accuracy * r.yield(d, x, 0).mean));
    return sum;
  };
  EXPECT_GT(primaries(0), 2 * primaries(0.1));
}

// Pixels that take cascades from one library share some: the covariance of their noise is no more
// than the share of the library that each takes (docs/explanation/replay.md).
TEST(ReplayNoise, CorrelatesPixelsNoMoreThanTheyShareCascades) {
  const Scan scan = test::row_of_pixels(0, 1, 8);
  Beam beam;
  beam.energy_ev = 400;
  const Scene scene(test::flat("Si"), beam, scan);
  constexpr int primaries = 1024;  // half the library
  SimulationOptions options;
  options.method = Method::replay;
  options.budget = ElectronsPerPixel{primaries};
  options.threads = 1;
  // Among pixels of one library the scatter is that of the pixels' own part, between libraries that
  // of all.
  test::Sample own, means;
  for (int seed = 1; seed <= seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const auto r = simulate(scene, options, {.libraries = &libraries()});
    test::Sample pixels;
    for (int x = 0; x < scan.width; ++x) {
      pixels.add(r.yield(test::se, x, 0).mean);
      own.add(std::pow(r.yield(test::se, x, 0).standard_error, 2));
    }
    means.add(pixels.mean());
  }
  // Var(mean of 8) = (1 + 7 c) / 8 Var(pixel).
  const double ratio = std::pow(means.standard_error(), 2) * seeds / own.mean();
  const double correlation = (8 * ratio - 1) / 7;
  const double error = 8.0 / 7 * ratio * std::sqrt(2.0 / (seeds - 1));
  const double bound = double(primaries) / double(CascadeLibrary::page_cascades);
  RecordProperty("correlation", std::to_string(correlation));
  EXPECT_LT(correlation, bound + test::z_limit(2) * error);
  EXPECT_GT(correlation, 0.2 * bound);  // they do share
}

}  // namespace surf::mc
