// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/sweep_job.h"

#include <gmock/gmock.h>

#include "small_job.h"
#include "surf/core/error.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

SweepJob tilts(const fs::path& folder, const std::vector<double>& tilts_deg) {
  SweepJob job;
  job.folder = folder;
  job.axes = {"tilt"};
  for (const double tilt_deg : tilts_deg) {
    const std::string value = std::to_string(tilt_deg);
    job.runs.push_back({{value}, [folder, tilt_deg, value] {
                          SimulateJob run = small_job();
                          run.scene.beam.tilt_deg = tilt_deg;
                          run.scene.budget = mc::ElectronsPerPixel{2};
                          run.outputs = {folder / ("tilt_" + value + ".exr")};
                          return run;
                        }});
  }
  return job;
}

TEST(SweepJob, GoesOnInItsOwnFolder) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(run(tilts(folder.path(), {0, 10})).found, 0u);
  const std::string table = bytes_of(folder.path() / "sweep.csv");
  EXPECT_EQ(run(tilts(folder.path(), {0, 10})).found, 2u);
  EXPECT_EQ(bytes_of(folder.path() / "sweep.csv"), table);
}

TEST(SweepJob, LeavesAnotherGridAlone) {
  const test::TemporaryFolder folder;
  run(tilts(folder.path(), {0, 10}));
  const std::string table = bytes_of(folder.path() / "sweep.csv");
  try {
    run(tilts(folder.path(), {0, 20}));
    ADD_FAILURE() << "the first sweep's table is lost";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("another grid: 2 runs over tilt"));
  }
  EXPECT_EQ(bytes_of(folder.path() / "sweep.csv"), table);
  EXPECT_FALSE(fs::exists(folder.path() / "tilt_20.000000.exr"));
}

}  // namespace
}  // namespace surf::workflow
