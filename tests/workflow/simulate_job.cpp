// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/simulate_job.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/workflow/version.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(SimulateJob, WritesTheSameBytesForAnyThreadsTilesAndPaths) {
  const TemporaryFolder folder;
  for (const char* extension : {".exr", ".tif", ".png"}) {
    std::string first;
    for (const auto& [threads, tile] :
         {std::pair{1, 1024}, {2, 1024}, {7, 1}, {1, 7}, {2, 100000}}) {
      SimulateJob job = small_job();
      job.execution.threads = threads;
      job.execution.tile_pixels = tile;
      job.command_line += std::to_string(threads);
      job.outputs = {folder.path() / std::to_string(threads * 1000 + tile) /
                     (std::string("image") + extension)};
      run(job);
      const std::string bytes = bytes_of(job.outputs[0]);
      EXPECT_FALSE(bytes.empty());
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << extension << ", " << threads << " threads, tile " << tile;
    }
  }
}

TEST(SimulateJob, AnotherSeedGivesAnotherImage) {
  const TemporaryFolder folder;
  SimulateJob job = small_job();
  job.outputs = {folder.path() / "a.exr"};
  run(job);
  job.scene.seed = 2;
  job.outputs = {folder.path() / "b.exr"};
  run(job);
  const Image a = io::read_image(folder.path() / "a.exr");
  const Image b = io::read_image(folder.path() / "b.exr");
  EXPECT_FALSE(a.find("SE")->values == b.find("SE")->values);
}

TEST(SimulateJob, RecordsInTheImageWhatMadeIt) {
  const TemporaryFolder folder;
  io::write_text(folder.path() / "in" / "cube.off", "not read again\n");
  SimulateJob job = small_job();
  job.scene.inputs = {folder.path() / "in" / "cube.off"};
  job.outputs = {folder.path() / "image.exr"};
  const SimulateSummary summary = run(job);
  auto metadata = io::read_image(job.outputs[0]).metadata;

  EXPECT_EQ(metadata["semsurf.version"], version());
  EXPECT_EQ(metadata["title"], "small");
  EXPECT_EQ(metadata["input.1"], "cube.off sha256 " + io::sha256_of_file(job.scene.inputs[0]));
  EXPECT_EQ(metadata["beam.energy_ev"], "1000");
  EXPECT_EQ(metadata["beam.tilt_deg"], "0");
  EXPECT_EQ(metadata["scan.width"], "12");
  EXPECT_EQ(metadata["scan.pixel_x_nm"], "5");
  EXPECT_EQ(metadata["simulation.physics"], mc::format_physics(job.scene.physics));
  EXPECT_EQ(metadata["material.1.name"], "Si");
  for (const char* number : {"density_g_cm3", "barrier_ev", "work_function_ev", "plasmon_ev",
                             "valence_electrons", "loss_join_ev", "cutoff_ev", "constituents"})
    EXPECT_FALSE(metadata[std::string("material.1.") + number].empty()) << number;
  EXPECT_THAT(metadata["specimen.body.1"], StartsWith("cube, Si, 12 triangles"));
  EXPECT_EQ(metadata["specimen.substrate"], "Si, top at 0 nm");
  EXPECT_EQ(metadata["simulation.electrons"], "20");
  EXPECT_EQ(metadata["simulation.seed"], "1");
  EXPECT_EQ(metadata["balance.incident"], std::to_string(12 * 9 * 20));
  EXPECT_EQ(metadata["balance.se"], std::to_string(summary.result.balance.se));
  EXPECT_FALSE(metadata.contains("partial"));
  for (const auto& [key, value] : metadata)
    EXPECT_THAT(value, Not(HasSubstr(folder.path().string()))) << key;
}

TEST(SimulateJob, RecordsTheRunBesideTheImage) {
  const TemporaryFolder folder;
  SimulateJob job = small_job();
  job.outputs = {folder.path() / "image.exr", folder.path() / "image.png"};
  const SimulateSummary summary = run(job);
  EXPECT_THAT(names_in(folder.path()),
              testing::ElementsAre("image.exr", "image.png", "image.run.json"));
  EXPECT_EQ(summary.written.size(), 3u);

  const auto json = nlohmann::json::parse(bytes_of(folder.path() / "image.run.json"));
  EXPECT_EQ(json["command"], job.command_line);
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["primaries"], 12 * 9 * 20);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["outputs"].size(), 2u);
  EXPECT_GT(json["primaries_per_second"], 0);
  EXPECT_GT(json["steps"], json["primaries"]);
  EXPECT_GE(json["steps"], json["rays"]);
  EXPECT_GT(json["peak_memory_bytes"], 1 << 20);
  EXPECT_GE(json["scene"]["triangles"], 12);
  EXPECT_FALSE(json["physics"]["Si"].empty());
  EXPECT_THAT(json["start"].get<std::string>(), testing::MatchesRegex("20..-..-..T..:..:.*Z"));

  const auto electrons = json["balance"]["electrons"];
  std::int64_t lost = 0;
  for (const auto& count : electrons["lost"]) lost += count.get<std::int64_t>();
  EXPECT_EQ(electrons["incident"].get<std::int64_t>() + electrons["generated"].get<std::int64_t>(),
            electrons["se"].get<std::int64_t>() + electrons["bse"].get<std::int64_t>() +
                electrons["transmitted"].get<std::int64_t>() +
                electrons["absorbed"].get<std::int64_t>() + lost);
}

TEST(SimulateJob, WritesWhatIsDoneWhenCancelled) {
  const TemporaryFolder folder;
  SimulateJob job = small_job();
  job.execution.tile_pixels = 1;
  job.outputs = {folder.path() / "image.exr"};
  CancelToken cancel;
  const auto summary =
      run(job, {.on_progress = [&](double, double, std::string_view) { cancel.cancel(); },
                .cancel = &cancel});
  EXPECT_FALSE(summary.result.complete);
  const Image image = io::read_image(job.outputs[0]);
  EXPECT_EQ(image.metadata.at("partial"), "true");
  EXPECT_EQ(nlohmann::json::parse(bytes_of(folder.path() / "image.run.json"))["complete"], false);
  EXPECT_LT(summary.result.balance.incident, 12 * 9 * 20);
}

TEST(SimulateJob, RefusesBadJobsBeforeWritingAnything) {
  const TemporaryFolder folder;
  const auto fails_with_usage_error = [&](auto change) {
    SimulateJob job = small_job();
    job.outputs = {folder.path() / "image.exr"};
    change(job);
    EXPECT_THROW(run(job), UsageError);
  };
  fails_with_usage_error([](SimulateJob& job) { job.outputs[0].replace_extension(".jpg2"); });
  fails_with_usage_error([](SimulateJob& job) { job.outputs.push_back(job.outputs[0]); });
  const TemporaryFolder other;
  io::write_text(other.path() / "input.exr", "not looked into");
  fails_with_usage_error([&](SimulateJob& job) {
    job.scene.inputs = {other.path() / "input.exr"};
    job.outputs = {other.path() / "." / "input.exr"};
  });
  fails_with_usage_error([](SimulateJob& job) { job.scene.budget = mc::ElectronsPerPixel{0}; });
  fails_with_usage_error(
      [](SimulateJob& job) { job.scene.budget = mc::ElectronsPerPixel{1LL << 40}; });
  fails_with_usage_error([](SimulateJob& job) { job.execution.threads = -1; });
  fails_with_usage_error([](SimulateJob& job) { job.scene.beam.energy_ev = 5; });
  fails_with_usage_error([](SimulateJob& job) { job.scene.beam.tilt_deg = 90; });
  fails_with_usage_error(
      [](SimulateJob& job) { job.scene.scan.width = job.scene.scan.height = 1 << 20; });
  fails_with_usage_error([](SimulateJob& job) {
    job.outputs[0].replace_extension(".png");
    job.png_channel = "TE";
  });
  EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(SimulateJob, RefusesUnusableSpecimensAndTargets) {
  const TemporaryFolder folder;
  SimulateJob job = small_job();
  job.outputs = {folder.path() / "image.exr"};
  job.scene.specimen.bodies[0].mesh.triangles.pop_back();
  EXPECT_THROW(run(job), InvalidInput);

  job = small_job();
  io::write_text(folder.path() / "file", "in the way\n");
  job.outputs = {folder.path() / "file" / "image.exr"};
  EXPECT_THROW(run(job), FileError);
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("file"));
}

}  // namespace
}  // namespace surf::workflow
