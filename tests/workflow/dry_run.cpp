// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/dry_run.h"

#include <gmock/gmock.h>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/core/grid.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;

SimulateJob job_in(const std::filesystem::path& folder) {
  SimulateJob job = small_job();
  job.outputs = {folder / "image.tif", folder / "image.png"};
  return job;
}

double bytes_of(const DryRun& run, const std::string& what) {
  for (const DiskNeed& need : run.disk)
    if (need.what == what) return need.bytes;
  return -1;
}

TEST(DryRun, WritesNothing) {
  const test::TemporaryFolder folder;
  const DryRun run = dry_run(job_in(folder.path()), 1, 0.2);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(run.scan.width, 12);
  EXPECT_GT(run.pilot.primaries, 0);
  EXPECT_GT(run.expected_s, 0);
  EXPECT_GT(run.memory_bytes, 1e6);
}

TEST(DryRun, FilesAreNoLargerThanItSays) {
  const test::TemporaryFolder folder;
  for (const io::Layout layout : {io::Layout::rows, io::Layout::tiles}) {
    SimulateJob job = job_in(folder.path());
    job.scene.scan.width = job.scene.scan.height = 384;  // three tiles across
    job.scene.scan.pixel_x_nm = job.scene.scan.pixel_y_nm = 0.2;
    job.scene.budget = mc::ElectronsPerPixel{1};
    job.layout = layout;
    const DryRun run = dry_run(job, 1, 0.2);
    workflow::run(job);
    for (const auto& output : job.outputs) {
      const auto size = static_cast<double>(std::filesystem::file_size(output));
      // Text comes on top, a page of it for each channel and size.
      EXPECT_LT(size, bytes_of(run, output.filename().string()) + 200e3);
      if (output.extension() == ".tif") {
        EXPECT_GT(size, 0.95 * bytes_of(run, "image.tif"));
      }
    }
  }
}

TEST(DryRun, CountsTheFewElectronsOfGuidedImages) {
  const test::TemporaryFolder folder;
  SimulateJob job = job_in(folder.path());
  job.scene.method = mc::Method::direct;
  job.scene.budget = mc::Accuracy{0.05, 0.002};
  job.estimate.kind = Estimate::guided;
  EXPECT_NEAR(dry_run(job, 1, 0.2).pilot.primaries, 12 * 9 * 40, 12 * 9);
  job.scene.budget = mc::ElectronsPerPixel{4};
  EXPECT_THROW(dry_run(job, 1, 0.2), UsageError);
}

TEST(DryRun, LargeImagesHaveScratchFiles) {
  const test::TemporaryFolder folder;
  SimulateJob job = job_in(folder.path());
  EXPECT_EQ(bytes_of(dry_run(job, 1, 0.1), "scratch file"), -1);
  job.execution.tally_memory = 0;
  const DryRun run = dry_run(job, 1, 0.1);
  EXPECT_EQ(bytes_of(run, "scratch file"),
            static_cast<double>(mc::tally_bytes(run.scan, mc::options_of(job.scene))));
}

TEST(DryRun, RanksShareTheTime) {
  const test::TemporaryFolder folder;
  const SimulateJob job = job_in(folder.path());
  const DryRun run = dry_run(job, 4, 0.1);
  EXPECT_DOUBLE_EQ(run.expected_s, run.pilot.expected_s / 4);
  EXPECT_EQ(run.ranks, 4);
}

TEST(DryRun, ATimeToKeepToIsTheTime) {
  const test::TemporaryFolder folder;
  SimulateJob job = job_in(folder.path());
  job.scene.budget = mc::TimeLimit{12};
  EXPECT_EQ(dry_run(job, 1, 0.1).expected_s, 12);
}

TEST(DryRun, RefusesWhatARunRefuses) {
  const test::TemporaryFolder folder;
  SimulateJob job = job_in(folder.path());
  job.png_channel = "nothing";
  EXPECT_THROW(dry_run(job, 1, 0.1), UsageError);
  job = job_in("/proc/nowhere");
  EXPECT_THROW(dry_run(job, 1, 0.1), FileError);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(dry_run(job_in(folder.path()), 1, 0.1, {.cancel = &cancel}), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
