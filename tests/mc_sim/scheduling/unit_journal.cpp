// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/unit_journal.h"

#include <gmock/gmock.h>

#include <limits>
#include <map>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/results/serialize.h"

namespace surf::mc {

namespace {

/// Keeps units packed, in memory.
class Memory : public UnitJournal {
 public:
  bool recall(std::size_t unit, UnitTally& tally) override {
    asked.push_back(unit);
    const auto found = units.find(unit);
    if (found == units.end()) return false;
    tally = deserialize(found->second);
    return true;
  }
  void record(std::size_t unit, const UnitTally& tally) override {
    EXPECT_TRUE(units.emplace(unit, serialize(tally)).second) << "unit " << unit << " came twice";
  }

  std::map<std::size_t, std::string> units;
  std::vector<std::size_t> asked;
};

SimulationOptions with_spectra(int threads) {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{30};
  options.spectra = true;
  options.threads = threads;
  options.tile_pixels = 5;
  return options;
}

const Scan scan = test::square_scan(84, 9);

Scene small_scene() { return Scene(test::flat("Si"), {}, scan); }

void expect_same(const SimulationResult& a, const SimulationResult& b) {
  const Image image_a = make_image(a, scan), image_b = make_image(b, scan);
  for (std::size_t c = 0; c < image_a.channels.size(); ++c)
    EXPECT_EQ(image_a.channels[c].values, image_b.channels[c].values);
  EXPECT_EQ(a.balance.rays, b.balance.rays);
  EXPECT_EQ(a.balance.incident, b.balance.incident);
  EXPECT_EQ(a.balance.deposited_energy.parts(), b.balance.deposited_energy.parts());
  ASSERT_EQ(a.spectra.size(), b.spectra.size());
  for (std::size_t d = 0; d < a.spectra.size(); ++d) {
    EXPECT_EQ(a.spectra[d].energy_ev.bins, b.spectra[d].energy_ev.bins);
    EXPECT_EQ(a.spectra[d].polar_deg.bins, b.spectra[d].polar_deg.bins);
    EXPECT_EQ(a.spectra[d].azimuth_deg.bins, b.spectra[d].azimuth_deg.bins);
  }
}

}  // namespace

TEST(UnitJournal, IsToldOfEveryUnitAndGivesTheSameResultBack) {
  const Scene scene = small_scene();
  const SimulationResult plain = simulate(scene, with_spectra(2));
  Memory journal;
  const SimulationResult first = simulate(scene, with_spectra(2), {.journal = &journal});
  expect_same(first, plain);
  EXPECT_EQ(first.recalled, 0);
  EXPECT_EQ(journal.units.size(), 18u);  // runs of 5 and 4 pixels in each of 9 rows

  for (std::size_t unit = 0; unit < 18; unit += 3) journal.units.erase(unit);
  const std::size_t known = journal.units.size();
  const SimulationResult second = simulate(scene, with_spectra(1), {.journal = &journal});
  expect_same(second, plain);
  EXPECT_EQ(known, 12u);
  EXPECT_EQ(journal.units.size(), 18u);
  EXPECT_EQ(second.recalled, 6 * 5 * 30 + 6 * 4 * 30);

  const SimulationResult third = simulate(scene, with_spectra(2), {.journal = &journal});
  expect_same(third, plain);
  EXPECT_EQ(third.recalled, third.balance.incident);
}

TEST(UnitJournal, IsAskedInTheOrderOfUnits) {
  Memory journal;
  simulate(small_scene(), with_spectra(1), {.journal = &journal});
  EXPECT_EQ(journal.asked.size(), 18u);
  EXPECT_TRUE(std::is_sorted(journal.asked.begin(), journal.asked.end()));
}

/// Cancels where a unit is about to begin.
class Stopping : public Memory {
 public:
  bool recall(std::size_t unit, UnitTally& tally) override {
    if (unit == 7) cancel.cancel();
    return Memory::recall(unit, tally);
  }
  CancelToken cancel;
};

TEST(UnitJournal, IsNotToldOfUnitsThatWereAbandonedAndGetsThemLater) {
  const Scene scene = small_scene();
  const SimulationOptions options = with_spectra(1);
  const SimulationResult plain = simulate(scene, options);
  Stopping journal;
  const SimulationResult stopped =
      simulate(scene, options, {.watch = {{}, &journal.cancel}, .journal = &journal});
  EXPECT_FALSE(stopped.complete);
  EXPECT_EQ(journal.units.size(), 7u) << "the unit that had begun is left out";
  expect_same(simulate(scene, options, {.journal = &journal}), plain);
}

TEST(UnitJournal, WhatObserversHaveSeenOfAUnitCounts) {
  struct Stop : Observer {
    void primary(std::int64_t, std::int64_t) override {
      if (++seen == 4) cancel.cancel();
    }
    CancelToken cancel;
    std::int64_t seen = 0;
  } observer;
  const SimulationResult r =
      simulate(small_scene(), with_spectra(1),
               {.watch = {{}, &observer.cancel}, .observers = [&](int) { return &observer; }});
  EXPECT_FALSE(r.complete);
  EXPECT_EQ(r.balance.incident, observer.seen);
}

TEST(UnitJournal, OfAnotherSimulationIsRefused) {
  const Scene scene = small_scene();
  Memory journal;
  simulate(scene, with_spectra(1), {.journal = &journal});
  SimulationOptions other = with_spectra(1);
  other.tile_pixels = 3;
  EXPECT_THROW(simulate(scene, other, {.journal = &journal}), InvalidInput);
  other = with_spectra(1);
  other.detectors = parse_detectors("in-lens", "test");
  EXPECT_THROW(simulate(scene, other, {.journal = &journal}), InvalidInput);
  EXPECT_THROW(simulate(scene, with_spectra(1),
                        {.observers = [](int) { return nullptr; }, .journal = &journal}),
               UsageError);
}

TEST(Pack, KeepsEveryNumber) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  UnitTally t;
  t.pixels = Grid<PixelTally>(2, 1);
  t.pixels(0, 0) = {most, 63};
  t.pixels(1, 0) = {64, 0};
  t.counts = {Grid<Counts>(2, 1), Grid<Counts>(2, 1, {7, most})};
  t.balance.incident = -most - 1;
  t.balance.lost[2] = -1;
  t.balance.rays = 1234567890123;
  t.balance.deposited_energy = EnergySum::of_parts(-5);
  const UnitTally back = deserialize(serialize(t));
  EXPECT_EQ(back.pixels(0, 0).primaries, most);
  EXPECT_EQ(back.pixels(0, 0).hits, 63);
  EXPECT_EQ(back.pixels(1, 0).primaries, 64);
  EXPECT_EQ(back.counts, t.counts);
  EXPECT_EQ(back.balance.incident, -most - 1);
  EXPECT_EQ(back.balance.lost[2], -1);
  EXPECT_EQ(back.balance.rays, 1234567890123);
  EXPECT_EQ(back.balance.deposited_energy.parts(), -5);
  EXPECT_EQ(serialize(back), serialize(t));
}

TEST(Pack, RefusesWhatIsNoTally) {
  const std::string good =
      serialize(simulate_unit(small_scene(), with_spectra(1), {0, 0, 3, 2, 0, 10}));
  EXPECT_EQ(serialize(deserialize(good)), good);
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(deserialize(std::string_view(good).substr(0, n)), InvalidInput) << n;
  EXPECT_THROW(deserialize(good + '\0'), InvalidInput);
  // Whatever the bytes: an error or a tally, and no more memory than they stand for.
  RandomStream random(1, 2, 3);
  for (int i = 0; i < 20000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k)
      bad[static_cast<std::size_t>(random.uniform() * (k == 0 ? 8 : double(bad.size())))] =
          static_cast<char>(random.bits());
    try {
      deserialize(bad);
    } catch (const InvalidInput&) {
    }
  }
}

}  // namespace surf::mc
