// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/guided_simulation.h"

#include <gmock/gmock.h>

#include <cmath>

#include "guided/guided_images.h"
#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/workflow/simulate_job.h"
#include "temporary_folder.h"
#include "thread_team.h"

namespace surf::workflow {
namespace {

using test::as_team;
using test::TemporaryFolder;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

SimulateJob guided_job() {
  SimulateJob job = small_job();
  job.scene.scan.width = 24;
  job.scene.scan.height = 20;
  job.scene.scan.pixel_x_nm = job.scene.scan.pixel_y_nm = 4;
  job.scene.method = mc::Method::direct;
  job.estimate.kind = Estimate::guided;
  job.execution.tile_pixels = 64;
  return job;
}

SimulateJob job_in_rounds() {
  SimulateJob job = guided_job();
  job.scene.budget = mc::Accuracy{0.05, 0.01};
  return job;
}

double rms_share(const Image& image, const Image& truth, const std::string& name) {
  double sum = 0;
  const auto &a = image.find(name)->values.data(), &b = truth.find(name)->values.data();
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow((a[i] - b[i]) / b[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(GuidedSimulation, IsNearerToTheTruthThanPlainAndSaysHowNear) {
  SimulateJob job = guided_job();
  job.scene.budget = mc::ElectronsPerPixel{800};
  job.scene.seed = 77;
  job.estimate.kind = Estimate::plain;
  const Image truth = image_of(run(job));
  job.scene.budget = mc::ElectronsPerPixel{48};
  job.scene.seed = 1;
  const Image plain = image_of(run(job));
  job.estimate.kind = Estimate::guided;
  const SimulateSummary done = run(job);
  const Image guided = image_of(done);
  ASSERT_EQ(done.gains.size(), 2u);
  for (std::size_t d = 0; d < 2; ++d) {
    const std::string name = done.result.detectors[d].name;
    const double error = rms_share(guided, truth, name);
    EXPECT_LT(error, 0.6 * rms_share(plain, truth, name)) << name;
    EXPECT_GT(done.gains[d].error_share, 0.5 * error) << name;
    EXPECT_LT(done.gains[d].error_share, 2 * error) << name;
    EXPECT_GT(done.gains[d].electrons(), 3) << name;
  }
}

TEST(GuidedSimulation, RoundsGiveTheBytesOfOneThreadAndOneProcess) {
  const TemporaryFolder folder;
  SimulateJob job = job_in_rounds();
  job.extras.channels = {"electrons", "radius", "plain"};
  job.outputs = {folder.path() / "alone.exr"};
  const SimulateSummary alone = run(job);
  EXPECT_GT(alone.rounds, 1);
  EXPECT_EQ(alone.statistics.missed, 0);
  EXPECT_GT(alone.statistics.most_electrons, alone.statistics.fewest_electrons);
  const std::string wanted = bytes_of(folder.path() / "alone.exr");
  job.execution.threads = 3;
  job.outputs = {folder.path() / "threads.exr"};
  run(job);
  EXPECT_TRUE(bytes_of(folder.path() / "threads.exr") == wanted);
  for (const int size : {2, 3}) {
    job.execution.threads = 1;
    const fs::path image = folder.path() / (std::to_string(size) + ".exr");
    job.outputs = {image};
    EXPECT_THAT(as_team(size, [&](Team& team) { run(job, {}, &team); }), Each(IsEmpty()));
    EXPECT_TRUE(bytes_of(image) == wanted) << size;
  }
}

TEST(GuidedSimulation, GoesOnFromAnyRoundToTheSameBytes) {
  const TemporaryFolder folder;
  SimulateJob job = job_in_rounds();
  job.outputs = {folder.path() / "whole.exr"};
  const SimulateSummary whole = run(job);
  const std::string wanted = bytes_of(folder.path() / "whole.exr");
  for (const int rounds_before : {0, 1, 2}) {
    job.outputs = {folder.path() / (std::to_string(rounds_before) + ".exr")};
    CancelToken cancel;
    int rounds = 0, units = 0;
    Reporter stop;
    stop.cancel = &cancel;
    stop.on_note = [&](const std::string& text) { rounds += text.starts_with("round "); };
    stop.on_progress = [&](double, double, std::string_view things) {
      if (things == "primaries" && rounds == rounds_before && ++units == 3) cancel.cancel();
    };
    const SimulateSummary part = run(job, stop);
    EXPECT_FALSE(part.result.complete);
    EXPECT_EQ(part.rounds, rounds_before + 1);
    EXPECT_EQ(io::read_image(job.outputs[0]).metadata.at("partial"), "true");
    const SimulateSummary rest = run(job);
    EXPECT_TRUE(rest.result.complete);
    EXPECT_GT(rest.result.recalled, 0);
    EXPECT_EQ(rest.rounds, whole.rounds);
    EXPECT_TRUE(bytes_of(job.outputs[0]) == wanted) << rounds_before;
  }
}

TEST(GuidedSimulation, RoundsCountEachPrimaryOnce) {
  SimulateJob job = job_in_rounds();
  const SimulateSummary rounds = run(job);
  ASSERT_GT(rounds.rounds, 2);
  job.estimate.kind = Estimate::plain;
  job.scene.budget = mc::ElectronsPerPixel{rounds.statistics.most_electrons};
  const SimulateSummary at_once = run(job);
  int compared = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 24; ++x) {
      if (rounds.result.pixels(x, y).primaries != rounds.statistics.most_electrons) continue;
      ++compared;
      EXPECT_EQ(rounds.result.counts[0](x, y), at_once.result.counts[0](x, y));
      EXPECT_EQ(rounds.result.counts[1](x, y), at_once.result.counts[1](x, y));
    }
  EXPECT_GT(compared, 0);
}

TEST(GuidedSimulation, TimeBecomesANumberOfElectrons) {
  SimulateJob job = guided_job();
  job.scene.budget = mc::TimeLimit{1e-3, 0.002};  // less than the first round takes
  std::string said;
  Reporter listener;
  listener.on_note = [&](const std::string& text) { said += text; };
  const SimulateSummary in_time = run(job, listener);
  EXPECT_THAT(said, HasSubstr("32 electrons per pixel"));
  job.scene.budget = mc::ElectronsPerPixel{32};
  const SimulateSummary again = run(job);
  for (std::size_t d = 0; d < 2; ++d) EXPECT_EQ(in_time.guided[d].mean, again.guided[d].mean);
}

TEST(GuidedSimulation, IsChosenWhereItPays) {
  SimulateJob job = guided_job();
  job.estimate.kind = Estimate::automatic;
  job.scene.budget = mc::ElectronsPerPixel{16};
  EXPECT_TRUE(run(job).guided.empty());  // 480 pixels
  job.scene.scan.width = job.scene.scan.height = 40;
  const SimulateSummary done = run(job);
  EXPECT_FALSE(done.guided.empty());
  EXPECT_EQ(done.record.at("simulation.estimate"), "guided");
  job.scene.budget = mc::ElectronsPerPixel{2};
  EXPECT_TRUE(run(job).guided.empty());
}

TEST(GuidedSimulation, KeepsWhatTheMiddleOfTheBeamMissesAsItIs) {
  SimulateJob job = guided_job();
  job.scene.specimen.substrate.reset();
  job.scene.beam.spot_nm = 3;
  job.scene.budget = mc::ElectronsPerPixel{64};
  const SimulateSummary done = run(job);
  const Image image = image_of(done);
  int missed = 0, touched = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 24; ++x) {
      if (done.guided[0].radius_px(x, y) > 0) continue;
      ++missed;
      touched += done.result.counts[0](x, y).sum > 0;
      EXPECT_EQ(image.find("SE")->values(x, y),
                static_cast<float>(done.result.yield(0, x, y).mean));
    }
  EXPECT_GT(missed, 100);
  EXPECT_GT(touched, 5);
}

TEST(GuidedSimulation, SaysWhatItCannotDo) {
  SimulateJob job = guided_job();
  job.scene.budget = mc::ElectronsPerPixel{4};
  EXPECT_THAT([&] { run(job); }, testing::ThrowsMessage<UsageError>(HasSubstr("too few")));
  job.scene.budget = mc::ElectronsPerPixel{32};
  job.estimate.model = "no-such-model.json";
  EXPECT_THAT([&] { run(job); }, testing::ThrowsMessage<FileError>(HasSubstr("no-such-model")));
  job = small_job();
  job.extras.channels = {"radius"};
  EXPECT_THAT([&] { run(job); }, testing::ThrowsMessage<UsageError>(HasSubstr("guided")));
}

}  // namespace
}  // namespace surf::workflow
