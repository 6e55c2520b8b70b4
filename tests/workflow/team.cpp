// SPDX-License-Identifier: GPL-3.0-or-later
// Several threads as a team: what MPI does between processes, without it.
#include "surf/workflow/team.h"

#include <gmock/gmock.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "share_pieces.h"
#include "small_job.h"
#include "small_training.h"
#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"
#include "surf/workflow/chart_job.h"
#include "surf/workflow/sweep_job.h"
#include "surf/workflow/train_job.h"
#include "temporary_folder.h"
#include "thread_team.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using test::as_team;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// What a job has written, but for what tells of the run itself, by path below the folder.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && !entry.path().string().ends_with(".run.json"))
      files[fs::relative(entry.path(), folder).string()] = bytes_of(entry.path());
  return files;
}

void expect_same_files(const fs::path& folder, const std::map<std::string, std::string>& wanted,
                       int size) {
  const auto files = results_in(folder);
  EXPECT_EQ(files.size(), wanted.size()) << size;
  for (const auto& [name, bytes] : wanted) {
    ASSERT_TRUE(files.contains(name)) << name << " with " << size;
    EXPECT_TRUE(files.at(name) == bytes) << name << " with " << size;
  }
}

nlohmann::json ranks_in(const fs::path& record) {
  return nlohmann::json::parse(io::read_file(record))["ranks"];
}

template <class Value>
std::int64_t sum_of(const nlohmann::json& ranks, const Value& key) {
  std::int64_t sum = 0;
  for (const auto& rank : ranks) sum += rank[key].template get<std::int64_t>();
  return sum;
}

SweepJob small_sweep(const fs::path& folder, int runs) {
  SweepJob job;
  job.folder = folder;
  job.axes = {"seed"};
  for (int i = 1; i <= runs; ++i) {
    SimulateJob run = small_job();
    run.scene.seed = static_cast<std::uint64_t>(i);
    run.scene.method = mc::Method::direct;
    run.outputs = {folder / ("seed_" + std::to_string(i) + ".exr")};
    job.runs.push_back({{std::to_string(i)}, [run] { return run; }});
  }
  return job;
}

TEST(Team, AnErrorOfOneEndsAllAndTellsWhose) {
  std::atomic<int> went_on = 0;
  const auto errors = as_team(3, [&](Team& team) {
    together(&team, [&] {
      if (team.rank() == 1) throw InvalidInput("cube.stl", "it is not there", "Look for it");
    });
    ++went_on;
  });
  EXPECT_EQ(went_on, 0);
  EXPECT_THAT(errors, Each(HasSubstr("it is not there")));
  EXPECT_THAT(errors[0], HasSubstr("rank 1"));
  EXPECT_THAT(errors[1], Not(HasSubstr("rank")));
  EXPECT_THAT(errors[2], HasSubstr("rank 1"));
}

TEST(Team, ExchangesTextsByRankAndBroadcastsTheLeaders) {
  const auto errors = as_team(4, [&](Team& team) {
    const auto texts = team.exchange("from " + std::to_string(team.rank()));
    EXPECT_THAT(texts, testing::ElementsAre("from 0", "from 1", "from 2", "from 3"));
    std::string text = "of " + std::to_string(team.rank());
    team.broadcast(text);
    EXPECT_EQ(text, "of 0");
  });
  EXPECT_THAT(errors, Each(IsEmpty()));
}

TEST(Team, LeavesOverOnlyWhatKeepsAllBusyTogether) {
  EXPECT_EQ(pieces_of(60, 4, 4), 60u);   // even
  EXPECT_EQ(pieces_of(61, 64, 4), 60u);  // one that all share at the end
  EXPECT_EQ(pieces_of(63, 64, 4), 63u);  // three at a time are better than three one after another
  EXPECT_EQ(pieces_of(62, 1, 4), 62u);   // whose image has one tile only
  EXPECT_EQ(pieces_of(1, 64, 4), 0u);
  EXPECT_EQ(pieces_of(0, 64, 4), 0u);
}

TEST(Team, SimulatesToTheBytesOfOne) {
  const TemporaryFolder folder;
  SimulateJob job = small_job();
  job.execution.tile_pixels = 4;
  job.outputs = {folder.path() / "alone" / "cube.exr"};
  run(job);
  const auto wanted = results_in(folder.path() / "alone");
  for (const int size : {1, 2, 3, 4}) {
    const fs::path place = folder.path() / std::to_string(size);
    job.outputs = {place / "cube.exr"};
    const auto errors = as_team(size, [&](Team& team) { run(job, {}, &team); });
    EXPECT_THAT(errors, Each(IsEmpty()));
    expect_same_files(place, wanted, size);
    EXPECT_EQ(sum_of(ranks_in(place / "cube.run.json"), "primaries"), 12 * 9 * 20);
  }
}

TEST(Team, SweepsToTheBytesOfOne) {
  const TemporaryFolder folder;
  run(small_sweep(folder.path() / "alone", 5));
  const auto wanted = results_in(folder.path() / "alone");
  EXPECT_EQ(wanted.size(), 11u);
  for (const int size : {1, 2, 3, 4}) {
    const fs::path place = folder.path() / std::to_string(size);
    std::vector<std::size_t> told;
    const RunCallback tell = [&](std::size_t run, const std::vector<SweepYield>& yields) {
      told.push_back(run);
      EXPECT_EQ(yields.size(), 2u);
      EXPECT_GT(yields[0].mean, 0.1);
    };
    const auto errors = as_team(size, [&](Team& team) {
      const SweepSummary s = run(small_sweep(place, 5), {}, tell, &team);
      EXPECT_TRUE(s.complete);
      EXPECT_EQ(s.done, team.leads() ? 5u : 0u);
    });
    EXPECT_THAT(errors, Each(IsEmpty()));
    expect_same_files(place, wanted, size);
    EXPECT_THAT(told, testing::UnorderedElementsAre(0, 1, 2, 3, 4));
    const auto ranks = ranks_in(place / "sweep.run.json");
    EXPECT_EQ(sum_of(ranks, "primaries"), 5 * 12 * 9 * 20);
    EXPECT_EQ(sum_of(ranks, "whole_runs"), 5);  // 12 x 9 pixels are one tile
  }
}

TEST(Team, SharesFewRunsThatAreLeftOverUnitByUnit) {
  const TemporaryFolder folder;
  const auto sweep = [&](const char* name) {
    SweepJob job = small_sweep(folder.path() / name, 3);
    for (SweepRun& run : job.runs) {
      SimulateJob wide = run.make();
      wide.scene.scan.width = 40;
      wide.scene.budget = mc::ElectronsPerPixel{4};
      run.make = [wide] { return wide; };
    }
    return job;
  };
  run(sweep("alone"));
  const auto errors = as_team(2, [&](Team& team) { run(sweep("two"), {}, {}, &team); });
  EXPECT_THAT(errors, Each(IsEmpty()));
  expect_same_files(folder.path() / "two", results_in(folder.path() / "alone"), 2);
  const auto ranks = ranks_in(folder.path() / "two" / "sweep.run.json");
  EXPECT_EQ(sum_of(ranks, "whole_runs"), 2);
  EXPECT_EQ(sum_of(ranks, "primaries"), 3 * 40 * 9 * 4);
  EXPECT_EQ(ranks_in(folder.path() / "two" / "seed_3.run.json").size(), 2u);
}

TEST(Team, TrainsToTheBytesOfOne) {
  const TemporaryFolder folder;
  TrainJob job = small_training(folder.path() / "alone" / "m.json");
  job.surfaces = 4;
  job.energy_ev = 500;
  job.physics.secondaries = false;  // short cascades
  run(job);
  const auto wanted = results_in(folder.path() / "alone");
  EXPECT_EQ(wanted.size(), 5u);
  for (const int size : {1, 2, 3, 4}) {
    const fs::path place = folder.path() / std::to_string(size);
    job.output = place / "m.json";
    const auto errors = as_team(size, [&](Team& team) {
      const TrainSummary s = run(job, {}, &team);
      EXPECT_TRUE(s.complete);
      EXPECT_EQ(s.images_made, team.leads() ? 4 : 0);
    });
    EXPECT_THAT(errors, Each(IsEmpty()));
    expect_same_files(place, wanted, size);
    EXPECT_EQ(sum_of(ranks_in(place / "m.run.json"), "primaries"), 4 * 16 * 16 * 3);
  }
  // All there: nobody simulates.
  fs::remove(job.output);
  as_team(2, [&](Team& team) {
    const TrainSummary s = run(job, {}, &team);
    EXPECT_EQ(s.images_found, 4);
  });
  expect_same_files(folder.path() / "4", wanted, 2);
}

// Without times and memory.
std::vector<std::vector<std::string>> figures(const fs::path& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(io::read_file(csv));
  for (std::string line; std::getline(in, line);) {
    rows.push_back(io::split_csv_line(line));
    rows.back().erase(rows.back().begin() + 4, rows.back().begin() + 7);
  }
  return rows;
}

TEST(Team, ChartsToTheFiguresOfOne) {
  const TemporaryFolder folder;
  ChartJob job;
  job.scene = small_job().scene;
  job.scene.specimen.bodies.clear();
  job.scene.scan.width = job.scene.scan.height = 16;
  job.scene.beam.energy_ev = 500;
  job.scene.physics.secondaries = false;
  job.scene.budget = mc::ElectronsPerPixel{30};
  job.quick = true;
  job.threads = 1;
  job.reference_accuracy = 0.015;
  job.families = {"default", "secant"};
  job.folder = folder.path() / "alone";
  run(job);
  const auto wanted = results_in(folder.path() / "alone" / "models" / "images");
  for (const int size : {1, 3}) {
    job.folder = folder.path() / std::to_string(size);
    std::atomic<int> points = 0;
    const PointCallback tell = [&](const ChartPoint&) { ++points; };
    const auto errors =
        as_team(size, [&](Team& team) { EXPECT_TRUE(run(job, {}, tell, &team).complete); });
    EXPECT_THAT(errors, Each(IsEmpty()));
    EXPECT_EQ(points, 2);
    EXPECT_EQ(figures(job.folder / "chart.csv"), figures(folder.path() / "alone" / "chart.csv"))
        << size;
    EXPECT_TRUE(bytes_of(job.folder / "reference" / "1.exr") ==
                bytes_of(folder.path() / "alone" / "reference" / "1.exr"));
    for (const auto& [name, bytes] : results_in(job.folder / "models" / "images"))
      EXPECT_TRUE(name == "seconds.json" || wanted.at(name) == bytes) << name;
    EXPECT_EQ(sum_of(ranks_in(job.folder / "chart.run.json"), "whole_runs"),
              4);  // one is the reference
  }
}

TEST(Team, WhatTheLeaderIsToldToStopGoesOnWithAnotherNumberToTheSameBytes) {
  const TemporaryFolder folder;
  run(small_sweep(folder.path() / "alone", 6));
  const fs::path place = folder.path() / "team";
  CancelToken stop;
  const RunCallback tell = [&](std::size_t, const std::vector<SweepYield>&) { stop.cancel(); };
  const auto errors = as_team(3, [&](Team& team) {
    Reporter own;
    if (team.leads()) own.cancel = &stop;
    EXPECT_FALSE(run(small_sweep(place, 6), own, tell, &team).complete);
  });
  EXPECT_THAT(errors, Each(IsEmpty()));
  EXPECT_FALSE(fs::exists(place / "sweep.csv"));
  as_team(2, [&](Team& team) {
    const SweepSummary s = run(small_sweep(place, 6), {}, {}, &team);
    EXPECT_GE(s.found, 1u);
  });
  expect_same_files(place, results_in(folder.path() / "alone"), 2);
}

TEST(Team, WhoFailsInARunEndsTheSweepAndIsNamed) {
  const TemporaryFolder folder;
  const auto errors = as_team(3, [&](Team& team) {
    SweepJob job = small_sweep(folder.path(), 6);
    auto asked = std::make_shared<int>(0);  // the first is looked at by all
    if (team.rank() == 2)
      for (SweepRun& run : job.runs)
        run.make = [make = run.make, asked] {
          if (++*asked > 1) throw FileError("scan.gwy", "it is gone", "Bring it back");
          return make();
        };
    run(job, {}, {}, &team);
  });
  EXPECT_THAT(errors, Each(HasSubstr("it is gone")));
  EXPECT_THAT(errors[0], HasSubstr("rank 2"));
}

TEST(Team, WhatTheLeaderCannotWriteEndsAll) {
  const TemporaryFolder folder;
  const auto errors = as_team(2, [&](Team& team) {
    const RunCallback tell = [](std::size_t, const std::vector<SweepYield>&) {
      throw FileError("records", "the disk is full", "Make room");
    };
    run(small_sweep(folder.path(), 8), {}, tell, &team);
  });
  EXPECT_THAT(errors, Each(HasSubstr("the disk is full")));
}

TEST(Team, RefusesAFolderThatIsNotTheSameForAll) {
  const TemporaryFolder folder;
  const auto errors = as_team(2, [&](Team& team) {
    run(small_sweep(folder.path() / std::to_string(team.rank()), 4), {}, {}, &team);
  });
  EXPECT_THAT(errors, Each(HasSubstr("does not see what rank 0 writes")));
  EXPECT_TRUE(results_in(folder.path()).empty());
}

}  // namespace
}  // namespace surf::workflow
