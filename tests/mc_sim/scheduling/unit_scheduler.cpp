// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/unit_scheduler.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "thread_crew.h"

namespace surf::mc {
namespace {

using test::CrewRoom;
using test::ThreadCrew;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

const Scan scan = test::square_scan(84, 9);

SimulationOptions few_electrons() {
  SimulationOptions options;
  options.budget = ElectronsPerPixel{30};
  options.method = Method::direct;
  options.threads = 2;
  options.tile_pixels = 5;
  return options;
}

Scene flat_scene(const Scan& pixels = scan) { return Scene(test::flat("Si"), {}, pixels); }

TEST(UnitScheduler, GivesTheResultOfOneWhateverItsSize) {
  const Scene scene = flat_scene();
  const SimulationOptions options = few_electrons();
  const SimulationResult alone = simulate(scene, options);
  const Image image = make_image(alone, scan);
  for (const int size : {1, 2, 3, 4}) {
    CrewRoom room(size);
    SimulationResult result;
    const auto errors = test::on_ranks(size, [&](int rank) {
      ThreadCrew crew(room, rank);
      SimulationResult own = simulate(scene, options, {.scheduler = &crew});
      if (rank == 0) result = std::move(own);
    });
    EXPECT_THAT(errors, Each(IsEmpty()));
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.balance.incident, alone.balance.incident);
    EXPECT_EQ(result.balance.deposited_energy.parts(), alone.balance.deposited_energy.parts());
    const Image shared = make_image(result, scan);
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      EXPECT_EQ(shared.channels[c].values, image.channels[c].values) << size;
    // Nobody does what somebody else has done, and all that is handed out comes back.
    std::sort(room.handed.begin(), room.handed.end());
    std::sort(room.given.begin(), room.given.end());
    EXPECT_EQ(std::adjacent_find(room.handed.begin(), room.handed.end()), room.handed.end());
    EXPECT_EQ(room.given, room.handed);
    EXPECT_LE(room.handed.size(), UnitPlan(scan, options).units());
  }
}

TEST(UnitScheduler, DoesAllUnitsWhereTheLeaderHasNoThreadFree) {
  CrewRoom room(2);
  const std::size_t units = 50;
  std::vector<std::size_t> came;
  test::on_ranks(2, [&](int rank) {
    ThreadCrew crew(room, rank);
    std::size_t next = 0;
    if (rank == 0)
      return crew.lead([&] { return next < units ? std::optional(next++) : std::nullopt; },
                       [&](const FinishedUnit& unit) {
                         came.push_back(unit.number);
                         EXPECT_EQ(unit.rank, 1);
                         EXPECT_EQ(unit.bytes, "done " + std::to_string(unit.number));
                       }, nullptr);
    crew.follow([](const TakeUnit& take, const GiveUnit& give) {
      while (const auto unit = take()) give({*unit, 3, "done " + std::to_string(*unit)});
    }, 1, 0, nullptr);
  });
  std::vector<std::size_t> all(units);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(came, all);
}

TEST(UnitScheduler, WhoFailsInAUnitEndsTheSimulationAndIsNamed) {
  const Scene scene = flat_scene();
  CrewRoom room(3);
  const auto errors = test::on_ranks(3, [&](int rank) {
    ThreadCrew crew(room, rank);
    if (rank != 2) {
      simulate(scene, few_electrons(), {.scheduler = &crew});
      return;
    }
    crew.follow([](const TakeUnit& take, const GiveUnit&) {
      if (take()) throw InvalidInput("unit", "the disk is full", "Make room");
    }, 1, 1, nullptr);
  });
  EXPECT_THAT(errors[0], HasSubstr("rank 2"));
  EXPECT_THAT(errors[0], HasSubstr("the disk is full"));
  EXPECT_EQ(errors[1], "");
  EXPECT_THAT(errors[2], HasSubstr("the disk is full"));
}

TEST(UnitScheduler, RefusesTalliesOfAnotherScene) {
  CrewRoom room(2);
  SimulationOptions options = few_electrons();
  const auto errors = test::on_ranks(2, [&](int rank) {
    ThreadCrew crew(room, rank);
    SimulationOptions own = options;
    if (rank == 1) own.tile_pixels = 3;
    simulate(flat_scene(), own, {.scheduler = &crew});
  });
  EXPECT_THAT(errors[0], HasSubstr("another simulation"));
}

}  // namespace
}  // namespace surf::mc
