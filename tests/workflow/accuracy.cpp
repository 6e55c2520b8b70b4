// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "temporary_folder.h"
#include "warnings.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

// Short cascades: 500 eV without secondaries. So few primaries would be followed directly.
SimulateJob accurate_job(const std::filesystem::path& output) {
  SimulateJob job = small_job();
  job.scene.beam.energy_ev = 500;
  job.scene.physics.secondaries = false;
  job.scene.budget = mc::Accuracy{0.2, 0.05};
  job.scene.method = mc::Method::replay;
  job.extras.channels = {"electrons", "model", "variance_left"};
  job.outputs = {output};
  return job;
}

class AccuracyOf : public testing::TestWithParam<const char*> {};

TEST_P(AccuracyOf, SameBytesForAnyThreadsAndCache) {
  const TemporaryFolder folder;
  std::string first;
  for (const auto& [threads, cache] : {std::pair{1, ""}, {3, "cache"}, {2, "cache"}}) {
    SimulateJob job = accurate_job(folder.path() / (std::to_string(threads) + ".exr"));
    job.execution.threads = threads;
    mc::parse_physics(GetParam(), job.scene.physics);
    if (*cache) job.cache = folder.path() / cache;
    const SimulateSummary s = run(job);
    EXPECT_EQ(s.pages_loaded > 0, threads == 2);
    EXPECT_EQ(s.pages_made > 0, threads != 2);
    const std::string bytes = bytes_of(job.outputs[0]);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Tiers, AccuracyOf,
                         testing::Values("inelastic=monsel", "inelastic=dielectric"),
                         [](const auto& instance) {
                           return std::string(instance.param).substr(10);
                         });

TEST(Accuracy, IsReachedAndRecorded) {
  const TemporaryFolder folder;
  const SimulateJob job = accurate_job(folder.path() / "image.exr");
  const SimulateSummary s = run(job);
  EXPECT_EQ(s.statistics.missed, 0);
  const Image image = io::read_image(job.outputs[0]);
  EXPECT_EQ(image.metadata.at("simulation.accuracy"), "0.2");
  EXPECT_EQ(image.metadata.at("simulation.accuracy_floor"), "0.05");
  EXPECT_EQ(image.metadata.at("simulation.method"), "replay");
  EXPECT_EQ(image.metadata.at("library.cascades"), "10240");
  EXPECT_THAT(image.metadata.at("model"), HasSubstr("4 plane"));
  EXPECT_FALSE(image.metadata.contains("simulation.electrons"));
  const Channel &yield = *image.find("BSE"), &error = *image.find("BSE.stderr");
  const Channel &electrons = *image.find("electrons"), &model = *image.find("model");
  for (int y = 0; y < yield.values.height(); ++y)
    for (int x = 0; x < yield.values.width(); ++x) {
      EXPECT_LE(error.values(x, y), 1.1001 * std::max(0.05f, 0.2f * yield.values(x, y)))
          << x << ", " << y;
      EXPECT_GE(model.values(x, y), 2);
      if (model.values(x, y) != 4) {
        EXPECT_GE(electrons.values(x, y), 32);
      }
    }
  ASSERT_NE(image.find("BSE.variance_left"), nullptr);
  const auto record = nlohmann::json::parse(bytes_of(folder.path() / "image.run.json"));
  EXPECT_EQ(record["method"]["name"], "replay");
  EXPECT_EQ(record["method"]["library"]["cascades"], 10240);
  EXPECT_TRUE(record["balance"]["electrons"].contains("handed_over"));
}

TEST(Accuracy, FewPrimariesAreFollowedDirectly) {
  const TemporaryFolder folder;
  SimulateJob job = accurate_job(folder.path() / "1.exr");
  job.scene.method.reset();
  const SimulateSummary s = run(job);
  EXPECT_EQ(s.choice.method, mc::Method::direct);
  EXPECT_EQ(s.statistics.missed, 0);
  EXPECT_EQ(s.statistics.models[static_cast<std::size_t>(mc::PixelModel::direct)],
            s.statistics.seen);
  EXPECT_EQ(s.statistics.electrons[static_cast<std::size_t>(mc::PixelModel::direct)],
            std::llround(s.statistics.mean_electrons * static_cast<double>(s.statistics.seen)));
  const Image image = io::read_image(job.outputs[0]);
  EXPECT_EQ(image.metadata.at("simulation.method"), "direct");
  EXPECT_EQ(image.metadata.at("simulation.accuracy"), "0.2");
  job.execution.threads = 3;
  job.outputs = {folder.path() / "3.exr"};
  run(job);
  EXPECT_TRUE(bytes_of(folder.path() / "1.exr") == bytes_of(folder.path() / "3.exr"));
}

TEST(Accuracy, TimeFindsOneThatRepeatsExactly) {
  const TemporaryFolder folder;
  SimulateJob job = accurate_job(folder.path() / "time.exr");
  job.scene.budget = mc::TimeLimit{3, 0.05};
  std::string said;
  const SimulateSummary s =
      run(job, {.on_note = [&](const std::string& note) { said += note + "\n"; }});
  EXPECT_THAT(said, HasSubstr("repeats"));
  job.scene.budget = s.result.budget;
  job.outputs = {folder.path() / "accuracy.exr"};
  run(job);
  EXPECT_TRUE(bytes_of(folder.path() / "time.exr") == bytes_of(folder.path() / "accuracy.exr"));
}

TEST(Accuracy, TooShortATimeGivesTheCoarseImage) {
  const TemporaryFolder folder;
  SimulateJob job = accurate_job(folder.path() / "time.exr");
  job.scene.budget = mc::TimeLimit{1e-3, 0.05};
  std::string said;
  const SimulateSummary s =
      run(job, {.on_note = [&](const std::string& note) { said += note + "\n"; }});
  EXPECT_THAT(said, HasSubstr("too short: even 10 % accuracy took"));
  EXPECT_EQ(mc::accuracy_of(s.result.budget), 0.1);
  EXPECT_EQ(io::read_image(job.outputs[0]).metadata.at("simulation.accuracy"), "0.1");
}

TEST(Accuracy, WarnsWhereItIsNotReached) {
  mc::SimulationResult result;
  result.budget = mc::Accuracy{0.02};
  mc::ResultSummary summary;
  summary.seen = 50;
  EXPECT_THAT(warn_after(result, summary), testing::IsEmpty());
  summary.missed = 5;
  summary.worst = 1.5;
  EXPECT_THAT(
      warn_after(result, summary),
      testing::ElementsAre("5 of 50 pixels (10 %) did not reach the accuracy of 2 %; the worst "
                           "standard error is 1.5 times what was asked for"));
  result.complete = false;  // says so itself
  EXPECT_THAT(warn_after(result, summary), testing::IsEmpty());
}

TEST(Accuracy, DepositedEnergyCannotBeHadWithIt) {
  const TemporaryFolder folder;
  SimulateJob job = accurate_job(folder.path() / "image.vti");
  job.extras.deposit_cells = 4;
  EXPECT_THROW(run(job), UsageError);
}

}  // namespace
}  // namespace surf::workflow
