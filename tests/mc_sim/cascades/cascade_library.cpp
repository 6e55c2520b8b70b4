// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/cascades/cascade_library.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

#include <gmock/gmock.h>

#include "cascades/cascade_reader.h"
#include "statistics.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/transport/boundary.h"
#include "transport/detection.h"
#include "transport/endless.h"
#include "transport/transport.h"

namespace surf::mc {

static void PrintTo(const CascadeSettings& settings, std::ostream* out) {
  *out << settings.material.name << " from " << settings.start_energy_ev << " eV";
}

namespace {

using test::CascadeReader;
using test::PackedElectron;

CascadeSettings settings_of(const char* material, double beam_ev, const char* physics = "",
                            double cutoff_ev = 0) {
  CascadeSettings settings;
  settings.material = io::find_material(material, "test");
  if (*physics) parse_physics(physics, settings.physics);
  settings.physics.cutoff_ev = cutoff_ev;
  settings.start_energy_ev = beam_ev + settings.material.barrier_ev;
  return settings;
}

CascadeLibrary one_page(const CascadeSettings& settings) {
  CascadeLibrary library(settings);
  library.grow(1, 2);
  return library;
}

CascadeReader read(const CascadeLibrary& library, std::size_t number) {
  return {library.cascade(number), library.medium().cutoff_ev(), library.settings().start_energy_ev,
          library.medium().barrier_ev()};
}

struct SeenElectron {
  int parent = -1;
  std::vector<Vec3> points_nm;
  std::vector<double> energies_ev;
};

// Sees all tracks of one primary as they happen.
struct Witness {
  std::vector<SeenElectron> electrons;

  void begin_track(int number, int parent, int, const Vec3& at, const Vec3&, double energy_ev) {
    EXPECT_EQ(static_cast<std::size_t>(number), electrons.size());
    electrons.push_back({parent, {at}, {energy_ev}});
  }
  void scattered(bool, double energy_ev) { electrons.back().energies_ev.back() = energy_ev; }
  void segment(const Vec3&, const Vec3& to, double, double energy_ev, int) {
    electrons.back().points_nm.push_back(to);
    electrons.back().energies_ev.push_back(energy_ev);
  }
  void deposit(const Vec3&, const Vec3&, double) {}
  void end_track(TrackKind, const Vec3&, const Vec3&, double) {}
};

// Cascade `number` of a library, from the same random numbers, seen by a witness.
Witness witness(const CascadeLibrary& library, std::uint64_t number) {
  const CascadeSettings& s = library.settings();
  const std::vector<const Medium*> media{&library.medium()};
  Endless endless;
  Witness seen;
  Detection detection(default_detectors(), {}, false);
  Balance balance;
  Transport<Endless, Witness> transport(endless, media, s.physics.barrier, false, seen, detection,
                                        balance);
  RandomStream random(s.seed, std::uint64_t{1} << 47, number);
  transport.run({}, {0, 0, -1}, s.start_energy_ev, 0, random);
  return seen;
}

// Compares a packed electron and all that it generates with what was seen.
void expect_same(const CascadeReader& packed, std::size_t packed_number,
                 const std::vector<SeenElectron>& seen, std::size_t seen_number) {
  const PackedElectron& p = packed.electrons[packed_number];
  const SeenElectron& s = seen[seen_number];
  ASSERT_EQ(p.points_nm.size(), s.points_nm.size());
  for (std::size_t i = 0; i < p.points_nm.size(); ++i) {
    EXPECT_LE(length(p.points_nm[i] - s.points_nm[i]), 1.001 * p.blur_nm + 1e-9);
    const double e = s.energies_ev[i];
    EXPECT_LE(packed.energy_ev(std::max(p.energies[i] - 1, 0)),
              e);  // the root is kept to one part in 65535
    EXPECT_GE(packed.energy_ev(p.energies[i] + 1), e);
  }
  // Of one electron's children the last born is followed first.
  auto birth = p.births.rbegin();
  for (std::size_t child = seen_number + 1; child < seen.size(); ++child) {
    if (seen[child].parent != static_cast<int>(seen_number)) continue;
    ASSERT_NE(birth, p.births.rend());
    EXPECT_EQ(seen[child].points_nm[0], s.points_nm[birth->first]);
    expect_same(packed, birth->second, seen, child);
    ++birth;
  }
  EXPECT_EQ(birth, p.births.rend());
}

class Packing : public testing::TestWithParam<CascadeSettings> {};

TEST_P(Packing, KeepsEveryTrackOfEveryElectron) {
  const CascadeLibrary library = one_page(GetParam());
  for (const std::size_t number : {0, 1, 2, 3, 500, 2047}) {
    const CascadeReader packed = read(library, number);
    const Witness seen = witness(library, number);
    ASSERT_EQ(packed.electrons.size(), seen.electrons.size());
    expect_same(packed, 0, seen.electrons, 0);
  }
}

TEST_P(Packing, SaysTheTruthAboutEveryNode) {  // as far as the reader knows it
  const CascadeLibrary library = one_page(GetParam());
  for (std::size_t number = 0; number < 300; ++number) {
    const CascadeReader packed = read(library, number);
    for (const PackedElectron& e : packed.electrons) {
      EXPECT_TRUE(std::is_sorted(e.energies.rbegin(), e.energies.rend())) << "energies fall";
      for (const auto& [point, child] : e.births) {
        EXPECT_GT(point, 0u);
        EXPECT_LE(packed.electrons[child].energies[0], e.energies[point]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, Packing,
    testing::Values(settings_of("Si", 500), settings_of("Au", 3000), settings_of("PMMA", 1000),
                    settings_of("C", 1000, "secondaries=off"),
                    settings_of("Cu", 2000, "elastic=browning,barrier=off", 200)),
    [](const auto& test) {
      return test.param.material.name + std::to_string(int(test.param.start_energy_ev));
    });

// By the public way to follow electrons, with other random numbers.
TEST(CascadeLibrary, IsDistributedAsCascadesAre) {
  class Sums final : public Observer {
   public:
    Sums(double cutoff_ev) : counts(12), lowest_(cutoff_ev) {}
    void primary(std::int64_t, std::int64_t) override { finish(); }
    void begin_track(int, int, int generation, const Vec3&, const Vec3&, double energy) override {
      primary_ = generation == 0;
      if (primary_) return;
      ++secondaries_;
      ++counts[bin(energy)];
    }
    void segment(const Vec3&, const Vec3& to, double, double, int) override {
      if (primary_) depth_ = std::max(depth_, -to.z), extent_ = std::max(extent_, length(to));
    }
    void finish() {
      if (depth_ > 0 || extent_ > 0)
        depth.add(depth_), extent.add(extent_), secondaries.add(secondaries_);
      depth_ = extent_ = secondaries_ = 0;
    }
    std::size_t bin(double energy_ev) const {
      const double octave = 2 * std::log2(energy_ev / lowest_);
      return static_cast<std::size_t>(std::clamp(octave, 0.0, 11.0));
    }
    test::Sample depth, extent, secondaries;
    std::vector<std::int64_t> counts;  // of secondaries by energy

   private:
    double lowest_;
    bool primary_ = false;
    double depth_ = 0, extent_ = 0, secondaries_ = 0;
  };
  const CascadeLibrary library = one_page(settings_of("Si", 1000));
  const Medium& medium = library.medium();
  Sums sums(medium.cutoff_ev());
  CustomSpecimen specimen;
  specimen.media = {&medium};
  specimen.boundary = [](const Vec3&, const Vec3&, double, int) { return std::nullopt; };
  simulate_custom(specimen, {}, {0, 0, -1}, library.settings().start_energy_ev, 0,
                  BarrierModel::quantum, 5, 2048, &sums);
  sums.finish();

  test::Sample depth, extent, secondaries;
  std::vector<std::int64_t> counts(sums.counts.size());
  for (std::size_t i = 0; i < library.cascades(); ++i) {
    const CascadeReader packed = read(library, i);
    double deepest = 0, farthest = 0;
    for (const Vec3& p : packed.electrons[0].points_nm)
      deepest = std::max(deepest, -p.z), farthest = std::max(farthest, length(p));
    depth.add(deepest);
    extent.add(farthest);
    secondaries.add(static_cast<double>(packed.electrons.size() - 1));
    for (std::size_t k = 1; k < packed.electrons.size(); ++k)
      ++counts[sums.bin(packed.energy_ev(packed.electrons[k].energies[0]))];
  }
  const auto expect_equal = [](const test::Sample& a, const test::Sample& b) {
    test::expect_mean(a.mean(), std::hypot(a.standard_error(), b.standard_error()), b.mean(), 4);
  };
  expect_equal(depth, sums.depth);
  expect_equal(extent, sums.extent);
  expect_equal(secondaries, sums.secondaries);
  // Two samples of the same spectrum. Counts of one cascade depend on each other: chi-squared is
  // divided by how much more their total scatters than Poisson's would.
  double chi_squared = 0, cells = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double a = double(counts[i]), b = double(sums.counts[i]);
    if (a + b < 50) continue;
    chi_squared += (a - b) * (a - b) / (a + b);
    ++cells;
  }
  ASSERT_GE(cells, 5);
  const double n = static_cast<double>(library.cascades());
  const double clumping = std::max(
      1.0, n * secondaries.standard_error() * secondaries.standard_error() / secondaries.mean());
  EXPECT_LT(test::chi_squared_z(chi_squared / clumping, cells), test::z_limit(4));

  const CascadeStatistics statistics = describe(library, library.cascades());
  EXPECT_NEAR(statistics.electrons_per_cascade, 1 + secondaries.mean(), 1e-9);
  EXPECT_THAT(statistics.primary_depth_nm, testing::SizeIs(library.cascades()));
  double sum = 0;
  for (const double d : statistics.primary_depth_nm) sum += d;
  EXPECT_NEAR(sum / n, depth.mean(), 1e-9);
  RecordProperty("bytes_per_cascade", std::to_string(statistics.bytes_per_cascade));
  EXPECT_LT(statistics.bytes_per_cascade, 50'000) << "what the thesis needed";
}

TEST(CascadeLibrary, TakesOnlyPages) {
  const CascadeLibrary library = one_page(settings_of("Si", 200));
  const CascadePage page = library.make_page(0, 1);
  CascadeLibrary other(library.settings());
  const auto refuses = [&](const CascadePage& wrong) {
    EXPECT_THROW(other.add_page(std::make_shared<const CascadePage>(wrong)), InvalidInput);
  };
  refuses({});
  CascadePage cut = page;
  cut.starts.pop_back();
  refuses(cut);
  cut = page;
  cut.words.pop_back();
  refuses(cut);
  cut = page;
  std::swap(cut.starts[5], cut.starts[6]);
  refuses(cut);
  cut = page;
  std::fill(cut.words.begin() + 100, cut.words.end(), 0);
  refuses(cut);
  EXPECT_EQ(other.pages(), 0u);
  other.add_page(std::make_shared<const CascadePage>(page));
  EXPECT_EQ(other.cascades(), CascadeLibrary::page_cascades);
}

// Whatever page is taken, all that can be reached in it lies in it: the sanitizers see to that.
TEST(CascadeLibrary, TakesNoPageThatLeadsOutOfItself) {
  const CascadeLibrary library = one_page(settings_of("Si", 200));
  const CascadePage page = library.make_page(0, 1);
  std::mt19937_64 random(1);
  int taken = 0;
  for (int i = 0; i < 600; ++i) {
    CascadePage wrong = page;
    const std::size_t word = random() % (i % 2 ? wrong.words.size() : 200);
    wrong.words[word] ^= std::uint64_t{1} << random() % 64;
    if (i % 3 == 0) wrong.words[word] = random();
    CascadeLibrary other(library.settings());
    try {
      other.add_page(std::make_shared<const CascadePage>(std::move(wrong)));
    } catch (const InvalidInput&) {
      continue;
    }
    ++taken;
    describe(other, other.cascades());
  }
  EXPECT_GT(taken, 100) << "places and some energies may be anything";
  EXPECT_LT(taken, 500);
}

TEST(CascadeLibrary, KnowsWhatItWouldMake) {
  const CascadeLibrary library(settings_of("Si", 200));
  const CascadePage page = library.make_page(3, 2);
  EXPECT_TRUE(library.would_make(page, 3));
  EXPECT_FALSE(library.would_make(page, 2));
  EXPECT_FALSE(library.would_make({}, 3));
  CascadePage wrong = page;
  wrong.words[50] ^= 1;
  EXPECT_FALSE(library.would_make(wrong, 3));
  EXPECT_FALSE(CascadeLibrary(settings_of("Si", 201)).would_make(page, 3));
}

TEST(CascadeLibrary, IsTheSameOnAnyNumberOfThreads) {
  const CascadeLibrary library(settings_of("Al", 300));
  const CascadePage one = library.make_page(1, 1), many = library.make_page(1, 7);
  EXPECT_EQ(one.words, many.words);
  EXPECT_EQ(one.starts, many.starts);
}

TEST(CascadeLibrary, SharesItsFirstPages) {
  CascadeLibrary library(settings_of("Si", 100));
  library.grow(5000, 1);
  ASSERT_EQ(library.pages(), 3u);
  const CascadeLibrary first = library.first(2);
  EXPECT_EQ(first.pages(), 2u);
  EXPECT_EQ(first.cascade(4000).data(), library.cascade(4000).data());
  EXPECT_EQ(library.first(9).pages(), 3u);
}

TEST(CascadeLibrary, CountsWhatIsDone) {
  FreshLibraries fresh;
  double last = 0;
  const auto watch = [&](double done, double total) {
    EXPECT_EQ(total, 3000);
    EXPECT_GE(done, last);
    EXPECT_LE(done, total);
    last = done;
  };
  const auto library = fresh.library(settings_of("Si", 100), 3000, 2, {watch});
  EXPECT_EQ(library->cascades(), 4096u);
  EXPECT_EQ(last, 3000);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(fresh.library(settings_of("Si", 100), 3000, 2, {{}, &cancel}), Interrupted);
}

}  // namespace
}  // namespace surf::mc
