// SPDX-License-Identifier: GPL-3.0-or-later
// How replay takes cascades, shares them and keeps account.
#include <array>

#include "replay/replay_test.h"
#include "sampling/stratified_permutation.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/cascades/library_source.h"

namespace surf::mc {

namespace {

SimulationOptions replaying(std::int64_t electrons) {
  SimulationOptions options;
  options.method = Method::replay;
  options.budget = ElectronsPerPixel{electrons};
  options.threads = 1;
  return options;
}

Specimen mesa() {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"mesa", test::pillar(40, 30), 0});
  return s;
}

Beam slow() {
  Beam beam;
  beam.energy_ev = 300;
  return beam;
}

std::string refusal(const SimulationOptions& options, const Physics& physics = {},
                    const ObserverOfThread& observers = {}) {
  try {
    simulate(Scene(mesa(), slow(), test::square_scan(40, 2), physics), options,
             {.observers = observers});
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(StratifiedPermutation, TakesNoCascadeTwiceBeforeAllWereTaken) {
  for (const std::uint64_t cascades : {2048u, 10240u})
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      RandomStream random(1, seed, 0);
      const std::uint32_t a = random.bits(), b = random.bits();
      const StratifiedPermutation subset(cascades, a, b);
      std::vector<int> taken(cascades);
      for (std::uint64_t i = 0; i < cascades; ++i) ++taken[subset[i]];
      EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), static_cast<std::ptrdiff_t>(cascades));
      EXPECT_EQ(subset[cascades], subset[0]);
    }
}

TEST(StratifiedPermutation, SpreadsPixelsEvenly) {
  // Over many pixels every run of cascades is taken equally often, and as the second run, too.
  constexpr std::uint64_t cascades = 2048, runs = cascades / StratifiedPermutation::long_run;
  std::vector<std::int64_t> first(runs), tenth(runs);
  constexpr int pixels = 20000;
  for (int p = 0; p < pixels; ++p) {
    RandomStream random(3, static_cast<std::uint64_t>(p), 0);
    const std::uint32_t a = random.bits(), b = random.bits();
    const StratifiedPermutation subset(cascades, a, b);
    ++first[subset[0] / StratifiedPermutation::long_run];
    ++tenth[subset[9 * StratifiedPermutation::long_run] / StratifiedPermutation::long_run];
  }
  const std::vector<double> even(runs, double(pixels) / runs);
  test::expect_distributed(first, even, 2);
  test::expect_distributed(tenth, even, 2);
}

namespace {

void expect_same_for_any_threads(const Scene& scene) {
  const Scan& scan = scene.scan();
  test::SmallLibraries libraries(1);
  for (const double accuracy : {0.0, 0.3}) {
    std::vector<SimulationResult> results;
    for (const auto& [threads, tile] : {std::pair(1, 1), {2, 3}, {3, 1024}}) {
      SimulationOptions options = replaying(60);
      if (accuracy > 0) options.budget = Accuracy{accuracy};
      options.threads = threads;
      options.tile_pixels = tile;
      results.push_back(simulate(scene, options, {.libraries = &libraries}));
    }
    for (const SimulationResult& r : results) {
      for (const char* channel : {"SE", "SE.stderr", "BSE", "BSE.stderr", "valid"})
        EXPECT_EQ(make_image(r, scan).find(channel)->values,
                  make_image(results[0], scan).find(channel)->values);
      EXPECT_EQ(r.balance.deposited_energy.parts(), results[0].balance.deposited_energy.parts());
      EXPECT_EQ(r.balance.generated_energy.parts(), results[0].balance.generated_energy.parts());
      EXPECT_EQ(r.balance.incident, results[0].balance.incident);
      EXPECT_EQ(r.balance.rays, results[0].balance.rays);
    }
    test::expect_balanced(results[0].balance);
  }
}

}  // namespace

TEST(Replay, GivesTheSameNumbersForAnyThreadsAndTiles) {
  expect_same_for_any_threads(Scene(mesa(), slow(), test::square_scan(60, 4)));
}

// Electrons that change the material are followed directly.
TEST(Replay, GivesTheSameNumbersWithLossesInEvents) {
  Physics physics;
  parse_physics("inelastic=dielectric,auger=on", physics);
  Specimen s = mesa();
  s.materials.push_back(io::find_material("SiO2", "test"));
  s.bodies.push_back({"grain", make_box({-10, -10, 20}, {10, 10, 70}), 1});
  expect_same_for_any_threads(Scene(s, slow(), test::square_scan(60, 4), physics));
}

// All that a cascade generates is counted, as where every track is followed to its end.
TEST(Replay, GeneratesAsManySecondariesAsTracksFollowedToTheirEnd) {
  class Nobody final : public Observer {
  } nobody;
  const Scan scan = test::row_of_pixels(0, 15, 3);
  const Scene scene(mesa(), slow(), scan);
  SimulationOptions options = replaying(1 << 20);
  const Libraries libraries = test::make_libraries(scene, 2, 1);
  options.seed = 2;
  test::SceneSample replay;
  test::add_blocks(replay, *make_replay_worker(scene.impl(), options, libraries), scan, 40, 50);
  test::ZScores scores;
  for (int x = 0; x < 3; ++x) {
    test::Sample direct;
    for (int b = 0; b < 40; ++b)
      direct.add(static_cast<double>(
                     simulate_unit(scene, test::seeded(1), {x, 0, x + 1, 1, 50 * b, 50}, &nobody)
                         .balance.generated) /
                 50);
    const test::Sample& generated = replay.pixels[static_cast<std::size_t>(x)].generated;
    scores.compare(direct.mean(), direct.standard_error(), generated.mean(),
                   generated.standard_error(), "generated at pixel " + std::to_string(x));
  }
  scores.expect_none_large();
  test::expect_balanced(replay.balance);
}

// Where a material has no library, direct simulation takes its electrons over.
TEST(Replay, HandsOverWhereAMaterialHasNoLibrary) {
  Specimen s = test::flat("Si");
  s.materials.push_back(io::find_material("Au", "test"));
  s.bodies.push_back({"sphere", make_sphere({0, 0, 8}, 8, 2), 1});
  const Scan scan = test::row_of_pixels(0, 6, 3);
  Beam beam;
  beam.energy_ev = 600;
  const Scene scene(s, beam, scan);
  SimulationOptions options = replaying(1 << 20);
  options.detectors = parse_detectors("SE1", "test");
  for (const Detector& d : default_detectors()) options.detectors.push_back(d);
  for (const Detector& d : parse_detectors("SE2", "test")) options.detectors.push_back(d);
  test::SceneSample direct;
  test::add_blocks(direct, *make_direct_worker(scene.impl(), options), scan, 50, 40);
  for (const std::vector<bool>& with : {std::vector{true, false}, {false, true}}) {
    const Libraries libraries = test::make_libraries(scene, 5, 1, with);
    test::SceneSample replay;
    test::add_blocks(replay, *make_replay_worker(scene.impl(), options, libraries), scan, 40, 50);
    EXPECT_GT(replay.balance.handed_over, 500);
    test::expect_balanced(replay.balance);
    test::expect_same_sample(direct, replay, options.detectors);
  }
}

// Errors go by it: a library may hold more than was asked for.
TEST(Replay, ReportsTheCascadesThatThereAre) {
  class Generous final : public FreshLibraries {
   public:
    std::shared_ptr<const CascadeLibrary> library(const CascadeSettings& settings,
                                                  std::size_t asked, int threads,
                                                  const Watch& watch) override {
      return FreshLibraries::library(settings, asked + CascadeLibrary::page_cascades, threads,
                                     watch);
    }
  } generous;
  const SimulationOptions options = replaying(10);
  const Scene scene(mesa(), slow(), test::square_scan(40, 2));
  const auto r = simulate(scene, options, {.libraries = &generous});
  EXPECT_EQ(r.library_cascades, library_size(options, 10) + CascadeLibrary::page_cascades);
  EXPECT_EQ(simulate(scene, {}).library_cascades, 0u);
}

TEST(LibrarySize, KeepsTheLibraryToAQuarterOfTheVariance) {
  SimulationOptions options;
  EXPECT_GE(library_size(options, 1'000'000), 4'000'000u);
  options.budget = Accuracy{0.01};
  const auto share = [&](const CascadeYield& y) {  // of the variance asked for
    const double error = std::max(0.01 * y.mean, floor_of(options.budget));
    return y.variance / static_cast<double>(library_size(options, 1, std::array{y})) /
           (error * error);
  };
  EXPECT_EQ(library_size(options, 1), library_size(options, 1, std::array{CascadeYield{0, 0}}));
  for (const CascadeYield& y : {CascadeYield{1.1, 3}, {0.2, 0.16}, {0.01, 0.01}, {5, 100}})
    EXPECT_LE(share(y), 0.25) << y.mean;
  EXPECT_GT(share({5, 100}), 0.23);  // and it is no larger than that takes
  options.budget = Accuracy{0.01, 0};
  EXPECT_GT(library_size(options, 1, std::array{CascadeYield{0, 0}}), 0u);
}

TEST(LibrarySize, GrowsByWhatTheCascadesAreMeasuredToScatterAndFitsIntoMemory) {
  SimulationOptions options = replaying(10);
  options.budget = Accuracy{0.03, 0};
  options.threads = 1;
  const Scene scene(mesa(), slow(), test::square_scan(40, 2));
  const auto grown = simulate(scene, options);
  ASSERT_EQ(grown.cascade_yields.size(), 2u);  // one material, SE and BSE
  EXPECT_GT(grown.library_cascades, library_size(options, 1));
  EXPECT_EQ(grown.library_cascades, library_size(options, 1, grown.cascade_yields));
  options.library_memory = 0;
  EXPECT_EQ(simulate(scene, options).library_cascades, library_size(options, 1));
}

TEST(Replay, RefusesWhatItCannotDo) {
  using testing::HasSubstr;
  Physics lossless;
  lossless.loss = LossModel::none;
  EXPECT_THAT(refusal(replaying(10), lossless), HasSubstr("continuous loss"));
  EXPECT_THAT(refusal(replaying(10), {}, [](int) { return nullptr; }), HasSubstr("observers"));

  SimulationOptions accurate = replaying(10);
  accurate.budget = Accuracy{0.1};
  SimulationOptions wrong = accurate;
  wrong.method = Method::direct;
  EXPECT_THAT(refusal(wrong, {}, [](int) { return nullptr; }),
              HasSubstr("more primaries in some pixels"));
  wrong = accurate;
  wrong.budget = TimeLimit{10};
  EXPECT_THAT(refusal(wrong), HasSubstr("no clock"));
  wrong = accurate;
  wrong.spectra = true;
  EXPECT_THAT(refusal(wrong), HasSubstr("spectra"));
  for (const double accuracy : {1e-5, 1.5, -0.1}) {
    wrong.budget = Accuracy{accuracy};
    EXPECT_THAT(refusal(wrong), HasSubstr("0.01% to 100%"));
  }
  wrong = accurate;
  wrong.budget = Accuracy{0.1, -1};
  EXPECT_THAT(refusal(wrong), HasSubstr("0 or more"));
}

}  // namespace surf::mc
