// SPDX-License-Identifier: GPL-3.0-or-later
#include "team_scheduler.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "specimens.h"
#include "surf/core/error.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "surf/mc/simulate.h"
#include "thread_team.h"

namespace surf::workflow {
namespace {

using test::CrewRoom;
using test::ThreadTeam;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

const mc::Scan scan = test::square_scan(84, 9);

mc::SimulationOptions few_electrons() {
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{30};
  options.method = mc::Method::direct;
  options.threads = 2;
  options.tile_pixels = 5;
  return options;
}

mc::Scene flat_scene(const mc::Scan& pixels = scan) {
  return mc::Scene(test::flat("Si"), {}, pixels);
}

TEST(TeamScheduler, GivesTheResultOfOneWhateverItsSize) {
  const mc::Scene scene = flat_scene();
  const mc::SimulationOptions options = few_electrons();
  const mc::SimulationResult alone = mc::simulate(scene, options);
  const Image image = mc::make_image(alone, scan);
  for (const int size : {1, 2, 3, 4}) {
    CrewRoom room(size);
    mc::SimulationResult result;
    const auto errors = test::on_ranks(size, [&](int rank) {
      ThreadTeam team(room, rank, size);
      TeamScheduler scheduler(team);
      mc::SimulationResult own = mc::simulate(scene, options, {.scheduler = &scheduler});
      if (rank == 0) result = std::move(own);
    });
    EXPECT_THAT(errors, Each(IsEmpty()));
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.balance.incident, alone.balance.incident);
    EXPECT_EQ(result.balance.deposited_energy.parts(), alone.balance.deposited_energy.parts());
    const Image shared = mc::make_image(result, scan);
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      EXPECT_EQ(shared.channels[c].values, image.channels[c].values) << size;
    // Nobody does what somebody else has done, and all that is handed out comes back.
    std::sort(room.handed.begin(), room.handed.end());
    std::sort(room.given.begin(), room.given.end());
    EXPECT_EQ(std::adjacent_find(room.handed.begin(), room.handed.end()), room.handed.end());
    EXPECT_EQ(room.given, room.handed);
    EXPECT_LE(room.handed.size(), mc::UnitPlan(scan, options).units());
  }
}

TEST(TeamScheduler, DoesAllUnitsWhereTheLeaderHasNoThreadFree) {
  CrewRoom room(2);
  const std::size_t units = 50;
  std::vector<std::size_t> came;
  test::on_ranks(2, [&](int rank) {
    ThreadTeam team(room, rank, 2);
    std::size_t next = 0;
    if (rank == 0)
      return team.lead([&] { return next < units ? std::optional(next++) : std::nullopt; },
                       [&](const FinishedUnit& unit) {
                         came.push_back(unit.number);
                         EXPECT_EQ(unit.rank, 1);
                         EXPECT_EQ(unit.bytes, "done " + std::to_string(unit.number));
                       },
                       nullptr);
    team.follow(
        [](const TakeUnit& take, const GiveUnit& give) {
          while (const auto unit = take()) give({*unit, 3, "done " + std::to_string(*unit)});
        },
        1, 0, nullptr);
  });
  std::vector<std::size_t> all(units);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(came, all);
}

TEST(TeamScheduler, WhoFailsInAUnitEndsTheSimulationAndIsNamed) {
  const mc::Scene scene = flat_scene();
  CrewRoom room(3);
  const auto errors = test::on_ranks(3, [&](int rank) {
    ThreadTeam team(room, rank, 3);
    TeamScheduler scheduler(team);
    if (rank != 2) {
      mc::simulate(scene, few_electrons(), {.scheduler = &scheduler});
      return;
    }
    team.follow(
        [](const TakeUnit& take, const GiveUnit&) {
          if (take()) throw InvalidInput("unit", "the disk is full", "Make room");
        },
        1, 1, nullptr);
  });
  EXPECT_THAT(errors[0], HasSubstr("rank 2"));
  EXPECT_THAT(errors[0], HasSubstr("the disk is full"));
  EXPECT_EQ(errors[1], "");
  EXPECT_THAT(errors[2], HasSubstr("the disk is full"));
}

TEST(TeamScheduler, RefusesTalliesOfAnotherScene) {
  CrewRoom room(2);
  mc::SimulationOptions options = few_electrons();
  const auto errors = test::on_ranks(2, [&](int rank) {
    ThreadTeam team(room, rank, 2);
    TeamScheduler scheduler(team);
    mc::SimulationOptions own = options;
    if (rank == 1) own.tile_pixels = 3;
    mc::simulate(flat_scene(), own, {.scheduler = &scheduler});
  });
  EXPECT_THAT(errors[0], HasSubstr("another simulation"));
}

}  // namespace
}  // namespace surf::workflow
