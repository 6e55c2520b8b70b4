// SPDX-License-Identifier: GPL-3.0-or-later
// Counts of primaries of odd number, and simulations in rounds.
#include <gmock/gmock.h>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/mc/results/serialize.h"
#include "surf/mc/simulate.h"

namespace surf::mc {
namespace {

SimulationOptions counted(Method method, std::int64_t electrons) {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{electrons};
  options.method = method;
  options.odd_counts = true;
  options.threads = 2;
  return options;
}

Scene flat_scene() { return Scene(test::flat("Si"), {}, test::square_scan(84, 7)); }

std::shared_ptr<const PrimaryNumbers> numbers(std::int64_t first, std::int64_t end) {
  return std::make_shared<PrimaryNumbers>(
      PrimaryNumbers{Grid<std::int64_t>(7, 7, first), Grid<std::int64_t>(7, 7, end)});
}

void expect_same(const SimulationResult& a, const SimulationResult& b) {
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 7; ++x) {
      EXPECT_EQ(a.pixels(x, y).primaries, b.pixels(x, y).primaries);
      for (std::size_t d = 0; d < a.counts.size(); ++d) {
        EXPECT_EQ(a.counts[d](x, y), b.counts[d](x, y));
        EXPECT_EQ(a.odd_counts[d](x, y), b.odd_counts[d](x, y));
      }
    }
  EXPECT_EQ(a.balance.incident, b.balance.incident);
}

TEST(OddCounts, AreHalfOfThePrimaries) {
  const Scene scene = flat_scene();
  for (const Method method : {Method::direct, Method::replay}) {
    const SimulationResult r = simulate(scene, counted(method, 301));
    double odd = 0, all = 0;
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 7; ++x) {
        odd += static_cast<double>(r.odd_counts[0](x, y).sum);
        all += static_cast<double>(r.counts[0](x, y).sum);
        EXPECT_LE(r.odd_counts[0](x, y).squares, r.counts[0](x, y).squares);
      }
    // 14,700 primaries of a yield near 1 and a variance near 2.
    EXPECT_NEAR(odd / all, 150.0 / 301, 0.03);
  }
}

TEST(OddCounts, AreOfTheNumbersThatAreOdd) {
  const Scene scene = flat_scene();
  for (const std::int64_t first : {0, 1, 6, 7}) {
    SimulationOptions options = counted(Method::direct, 1);
    options.primaries = numbers(first, first + 1);
    const SimulationResult r = simulate(scene, options);
    std::int64_t all = 0;
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 7; ++x) {
        all += r.counts[0](x, y).sum;
        EXPECT_EQ(r.odd_counts[0](x, y), first % 2 == 1 ? r.counts[0](x, y) : Counts{}) << first;
      }
    EXPECT_GT(all, 0);
  }
}

TEST(OddCounts, RoundsAddUpToOneSimulation) {
  const Scene scene = flat_scene();
  for (const Method method : {Method::direct, Method::replay}) {
    SimulationOptions options = counted(method, 90);
    options.least_cascades = 12'000;
    const SimulationResult whole = simulate(scene, options);
    options.primaries = numbers(0, 33);
    SimulationResult rounds = simulate(scene, options);
    for (const auto& [first, end] : {std::pair{33, 64}, {64, 90}}) {
      options.primaries = numbers(first, end);
      add_round(rounds, simulate(scene, options));
    }
    expect_same(rounds, whole);
  }
}

TEST(OddCounts, ArePackedWithTheirUnit) {
  UnitTally tally = empty_tally({0, 0, 2, 1, 0, 8}, counted(Method::direct, 8));
  tally.odd_counts[1](1, 0) = {5, 7};
  const UnitTally back = deserialize(serialize(tally));
  ASSERT_EQ(back.odd_counts.size(), 2u);
  EXPECT_EQ(back.odd_counts[1](1, 0), (Counts{5, 7}));
}

TEST(OddCounts, RefuseWhatDoesNotGoTogether) {
  const Scene scene = flat_scene();
  SimulationOptions options = counted(Method::direct, 8);
  options.budget = Accuracy{0.5, 0.1};
  EXPECT_THROW(simulate(scene, options), UsageError);
  options = counted(Method::direct, 8);
  options.primaries = numbers(5, 4);
  EXPECT_THROW(simulate(scene, options), UsageError);
  SimulationResult one = simulate(scene, counted(Method::direct, 8));
  SimulationOptions plain = counted(Method::direct, 8);
  plain.odd_counts = false;
  EXPECT_THROW(add_round(one, simulate(scene, plain)), InvalidInput);
}

}  // namespace
}  // namespace surf::mc
