// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "small_job.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

/// Beside the cube: electrons cost nothing, pixels what they always cost.
SimulateJob job_of(int pixels, const std::filesystem::path& folder) {
  SimulateJob job = small_job();
  job.scene.specimen.substrate.reset();
  job.scene.scan = {};
  job.scene.scan.width = job.scene.scan.height = pixels;
  job.scene.scan.region = {100, 100, 120, 120};
  job.scene.budget = mc::ElectronsPerPixel{1};
  job.execution.threads = 2;
  for (const char* name : {"image.exr", "image.tif", "image.png"})
    job.outputs.push_back(folder / name);
  job.extras.channels = {"z_nm", "normal", "material", "electrons"};
  return job;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void expect_no_growth(io::Layout layout, double most_megabytes) {
  const test::TemporaryFolder folder;
  SimulateJob small = job_of(512, folder.path());
  small.execution.tally_memory = 0;
  small.layout = layout;
  run(small);
  const double before = peak_megabytes();
  // Sixteen times the pixels: 200 MB of tallies and 180 MB of channels.
  SimulateJob large = job_of(2048, folder.path());
  large.execution.tally_memory = 0;
  large.layout = layout;
  run(large);
  EXPECT_LT(peak_megabytes() - before, most_megabytes);
  std::printf("peak %.0f MB, then %.0f MB\n", before, peak_megabytes());
}

TEST(Memory, DoesNotGrowWithThePixels) { expect_no_growth(io::Layout::rows, 100); }

// A pyramid's first half size takes 45 MB.
TEST(Memory, DoesNotGrowWithThePixelsInTiles) { expect_no_growth(io::Layout::tiles, 150); }

TEST(Memory, WhereTalliesAreDoesNotChangeTheBytes) {
  const test::TemporaryFolder folder;
  std::vector<std::string> first;
  for (const std::size_t limit : {std::size_t{1} << 30, std::size_t{0}}) {
    SimulateJob job = small_job();
    job.execution.tally_memory = limit;
    for (const char* name : {"image.exr", "image.tif", "image.png"})
      job.outputs.push_back(folder.path() / std::to_string(limit) / name);
    run(job);
    std::vector<std::string> bytes;
    for (const auto& output : job.outputs) bytes.push_back(bytes_of(output));
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first);
  }
}

}  // namespace
}  // namespace surf::workflow
