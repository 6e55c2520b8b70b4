// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/unit_scheduler.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <vector>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/mc/scheduling/unit_plan.h"

namespace surf::mc {
namespace {

using testing::HasSubstr;

const Scan scan = test::square_scan(84, 9);

SimulationOptions few_electrons() {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{30};
  options.method = Method::direct;
  options.threads = 2;
  options.tile_pixels = 5;
  return options;
}

// One thread, the last unit first.
class Backwards : public UnitScheduler {
 public:
  bool collects() const override { return true; }
  void run(const UnitWork& work) override {
    std::vector<std::size_t> all;
    while (const auto number = work.take()) all.push_back(*number);
    units = all.size();
    std::ranges::reverse(all);
    for (const std::size_t number : all) {
      UnitTally tally;
      ASSERT_TRUE(work.simulate(number, 0, tally));
      work.finish(number, tally);
    }
  }
  void abandon(const std::exception_ptr&, const CancelToken*) override { abandoned = true; }

  std::size_t units = 0;
  bool abandoned = false;
};

TEST(UnitScheduler, TheResultDoesNotDependOnTheOrder) {
  const Scene scene(test::flat("Si"), {}, scan);
  const SimulationResult usual = simulate(scene, few_electrons());
  Backwards backwards;
  const SimulationResult result = simulate(scene, few_electrons(), {.scheduler = &backwards});
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(backwards.abandoned);
  EXPECT_EQ(backwards.units, UnitPlan(scan, few_electrons()).units());
  EXPECT_EQ(result.balance.deposited_energy.parts(), usual.balance.deposited_energy.parts());
  const Image a = make_image(result, scan), b = make_image(usual, scan);
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    EXPECT_EQ(a.channels[c].values, b.channels[c].values);
}

// What comes to nobody: units are done, and given elsewhere.
class Elsewhere : public Backwards {
 public:
  bool collects() const override { return false; }
  void run(const UnitWork& work) override {
    UnitTally tally;
    ASSERT_TRUE(work.simulate(0, 0, tally));
    EXPECT_GT(tally.balance.incident, 0);
  }
};

TEST(UnitScheduler, WhereNothingIsCollectedTheResultCountsNothing) {
  const Scene scene(test::flat("Si"), {}, scan);
  Elsewhere elsewhere;
  const SimulationResult result = simulate(scene, few_electrons(), {.scheduler = &elsewhere});
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.balance.incident, 0);
}

TEST(UnitScheduler, IsAbandonedWhereThereAreNoLibraries) {
  struct Cancelled : LibrarySource {
    std::shared_ptr<const CascadeLibrary> library(const CascadeSettings&, std::size_t, int,
                                                  const Watch&) override {
      throw Interrupted();
    }
  } none;
  const Scene scene(test::flat("Si"), {}, scan);
  SimulationOptions options = few_electrons();
  options.method = Method::replay;
  Backwards backwards;
  const SimulationResult result =
      simulate(scene, options, {.libraries = &none, .scheduler = &backwards});
  EXPECT_TRUE(backwards.abandoned);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(backwards.units, 0u);
}

TEST(ThreadScheduler, FinishesEveryUnitOnce) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::vector<int> finished(200, 0);
    ThreadScheduler().run({threads,
                           [&]() -> std::optional<std::size_t> {
                             const std::size_t number = next++;
                             return number < finished.size() ? std::optional(number) : std::nullopt;
                           },
                           [&](std::size_t number, int thread, UnitTally& tally) {
                             EXPECT_GE(thread, 0);
                             EXPECT_LT(thread, threads);
                             tally.balance.incident = static_cast<std::int64_t>(number);
                             return true;
                           },
                           [&](std::size_t number, const UnitTally& tally) {
                             const std::lock_guard lock(mutex);
                             EXPECT_EQ(tally.balance.incident, static_cast<std::int64_t>(number));
                             ++finished[number];
                           }});
    EXPECT_THAT(finished, testing::Each(1)) << threads;
  }
}

TEST(ThreadScheduler, AFailureEndsAllThreads) {
  std::atomic<std::size_t> next = 0;
  const UnitWork work{4, [&] { return std::optional(next++); },  // without end
                      [](std::size_t number, int, UnitTally&) -> bool {
                        if (number == 20)
                          throw InvalidInput("unit", "the disk is full", "Make room");
                        return true;
                      },
                      [](std::size_t, const UnitTally&) {}};
  try {
    ThreadScheduler().run(work);
    FAIL() << "it went on";
  } catch (const InvalidInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("the disk is full"));
  }
}

}  // namespace
}  // namespace surf::mc
