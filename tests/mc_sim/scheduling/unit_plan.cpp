// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/unit_plan.h"

#include "surf/mc/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

Scan scan_of(int width, int height) {
  Scan scan;
  scan.width = width;
  scan.height = height;
  return scan;
}

SimulationOptions options_of(Method method, std::int64_t electrons, double accuracy = 0) {
  SimulationOptions options;
  options.method = method;
  options.budget = ElectronsPerPixel{electrons};
  if (accuracy > 0) options.budget = Accuracy{accuracy};
  return options;
}

struct Case {
  const char* what;
  Scan scan;
  SimulationOptions options;
};

/// Few and many electrons against a unit's, sizes that units divide and that they do not.
std::vector<Case> cases() {
  SimulationOptions narrow = options_of(Method::direct, 1);
  narrow.tile_pixels = 5;
  return {{"direct", scan_of(64, 8), options_of(Method::direct, 200)},
          {"direct, odd", scan_of(37, 5), options_of(Method::direct, 200)},
          {"direct, one electron", scan_of(37, 5), options_of(Method::direct, 1)},
          {"direct, short runs", scan_of(37, 5), narrow},
          {"direct, split pixels", scan_of(3, 2), options_of(Method::direct, 10001)},
          {"direct, a chunk exactly", scan_of(3, 2), options_of(Method::direct, 4096)},
          {"replay", scan_of(70, 67), options_of(Method::replay, 200)},
          {"replay, split pixels", scan_of(5, 3), options_of(Method::replay, 200000)},
          {"accuracy", scan_of(70, 67), options_of(Method::replay, 1, 0.05)}};
}

/// What a simulation of the unit would have counted, without one: a count that tells pixels and
/// primaries apart.
UnitTally pretended(const WorkUnit& unit, const SimulationOptions& options) {
  UnitTally tally = empty_tally(unit, options);
  for (int y = unit.y0; y < unit.y1; ++y)
    for (int x = unit.x0; x < unit.x1; ++x) {
      PixelTally& pixel = tally.pixels(x - unit.x0, y - unit.y0);
      pixel.primaries = unit.electrons;
      pixel.hits = (unit.first_electron + 1) * (1 + x + 100 * y);
      tally.balance.incident += unit.electrons;
    }
  return tally;
}

bool same(const WorkUnit& a, const WorkUnit& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1 &&
         a.first_electron == b.first_electron && a.electrons == b.electrons;
}

bool same_pixels(const SimulationResult& a, const SimulationResult& b) {
  return std::ranges::equal(a.pixels.data(), b.pixels.data(),
                            [](const PixelTally& p, const PixelTally& q) {
                              return p.primaries == q.primaries && p.hits == q.hits;
                            });
}

TEST(UnitPlan, DoesEveryPrimaryOfEveryPixelOnce) {
  for (const Case& c : cases()) {
    const UnitPlan plan(c.scan, c.options);
    Grid<std::int64_t> next(c.scan.width,
                            c.scan.height);  // the primary that comes next, as units come in order
    for (std::size_t i = 0; i < plan.units(); ++i) {
      const WorkUnit u = plan.unit(i);
      ASSERT_TRUE(0 <= u.x0 && u.x0 < u.x1 && u.x1 <= c.scan.width) << c.what << ", unit " << i;
      ASSERT_TRUE(0 <= u.y0 && u.y0 < u.y1 && u.y1 <= c.scan.height) << c.what << ", unit " << i;
      ASSERT_GT(u.electrons, 0) << c.what << ", unit " << i;
      for (int y = u.y0; y < u.y1; ++y)
        for (int x = u.x0; x < u.x1; ++x) {
          ASSERT_EQ(next(x, y), u.first_electron) << c.what << ", pixel " << x << ", " << y;
          next(x, y) += u.electrons;
        }
    }
    const std::int64_t wanted =
        accuracy_of(c.options.budget) > 0 ? plan.most() : electrons_of(c.options.budget);
    for (const std::int64_t n : next.data()) ASSERT_EQ(n, wanted) << c.what;
  }
}

TEST(UnitPlan, GoesUpToThePixelThatHasMostOfADose) {
  SimulationOptions options;
  options.budget = Dose{4000};
  const UnitPlan plan(scan_of(9, 7), options);
  EXPECT_GT(plan.most(), 4000);
  std::int64_t last = 0;
  for (std::size_t i = 0; i < plan.units(); ++i) {
    const WorkUnit u = plan.unit(i);
    last = std::max(last, u.first_electron + u.electrons);
  }
  EXPECT_EQ(last, plan.most());
  EXPECT_NEAR(plan.total(), 4000 * 63, 6 * std::sqrt(4000.0 * 63));
}

TEST(UnitPlan, DependsOnNoThreadsNorSeeds) {
  for (const Case& c : cases()) {
    SimulationOptions other = c.options;
    other.threads = 7;
    other.seed = 99;
    const UnitPlan one(c.scan, c.options), two(c.scan, other);
    ASSERT_EQ(one.units(), two.units()) << c.what;
    for (std::size_t i = 0; i < one.units(); ++i)
      ASSERT_TRUE(same(one.unit(i), two.unit(i))) << c.what;
  }
}

TEST(UnitPlan, CountsWhatIsDoneUpToTheTotal) {
  for (const Case& c : cases()) {
    const UnitPlan plan(c.scan, c.options);
    double done = 0;
    for (std::size_t i = 0; i < plan.units(); ++i)
      done += plan.done(plan.unit(i), pretended(plan.unit(i), c.options));
    EXPECT_EQ(done, plan.total()) << c.what;
  }
}

TEST(UnitPlan, SharesOfRanksMergeToTheWholeInAnyOrder) {
  for (const Case& c : cases()) {
    const UnitPlan plan(c.scan, c.options);
    SimulationResult whole = empty_result(c.scan, c.options);
    for (std::size_t i = 0; i < plan.units(); ++i)
      merge(whole, plan.unit(i), pretended(plan.unit(i), c.options));
    for (const std::size_t ranks : {2, 3}) {
      SimulationResult all = empty_result(c.scan, c.options);
      for (std::size_t rank = ranks; rank-- > 0;)
        for (std::size_t i = plan.units();
             i-- > 0;) {  // each sees all units, and leaves those of others empty
          const bool own = i % ranks == rank;
          merge(all, plan.unit(i),
                own ? pretended(plan.unit(i), c.options) : empty_tally(plan.unit(i), c.options));
        }
      EXPECT_TRUE(same_pixels(all, whole)) << c.what << ", " << ranks << " ranks";
      EXPECT_EQ(all.balance.incident, whole.balance.incident) << c.what;
    }
  }
}

TEST(UnitPlan, RefusesTalliesOfAnotherSimulation) {
  const SimulationOptions options = options_of(Method::direct, 200);
  const UnitPlan plan(scan_of(64, 8), options);
  SimulationResult result = empty_result(scan_of(64, 8), options);
  WorkUnit smaller = plan.unit(0);
  --smaller.x1;
  EXPECT_THROW(merge(result, plan.unit(0), empty_tally(smaller, options)), InvalidInput);
  SimulationOptions one_detector = options;
  one_detector.detectors.pop_back();
  EXPECT_THROW(merge(result, plan.unit(0), empty_tally(plan.unit(0), one_detector)), InvalidInput);
}

TEST(UnitPlan, LongJobsHaveLongerUnits) {
  const SimulationOptions options = options_of(Method::direct, 100);
  const auto primaries = [&](int side) {
    const WorkUnit unit = UnitPlan(scan_of(side, side), options).unit(0);
    return (unit.x1 - unit.x0) * (unit.y1 - unit.y0) * unit.electrons;
  };
  EXPECT_EQ(primaries(3000), 4000);   // 9e8 in all
  EXPECT_EQ(primaries(3200), 16300);  // 1.02e9
  // Pixels of very many primaries are cut as ever.
  EXPECT_EQ(UnitPlan(scan_of(3200, 3200), options_of(Method::direct, 10000)).unit(0).electrons,
            4096);
}

}  // namespace
}  // namespace surf::mc
