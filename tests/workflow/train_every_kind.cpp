// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of model from training to its file to an image.
#include <gmock/gmock.h>

#include <algorithm>

#include "small_job.h"
#include "small_training.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/predict_job.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

TrainJob job_of(const LearnableKind& kind, const fs::path& output) {
  TrainJob job = small_training(output);
  job.learn.kind = kind.name;
  job.surfaces.reset();
  if (kind.needs_images) job.surfaces = 2;
  else job.learn.table_electrons = 200;
  if (kind.name == "facet-network") job.learn.hidden = {3}, job.learn.iterations = 20;
  return job;
}

class TrainEveryKind : public testing::Test {
 protected:
  TrainSummary train(const LearnableKind& kind, const fs::path& output) {
    return run(job_of(kind, output));
  }

  LearnableKind kind(const std::string& name) const {
    const auto all = learnable_kinds();
    return *std::ranges::find(all, name, &LearnableKind::name);
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  test::TemporaryFolder folder_;
};

TEST_F(TrainEveryKind, FromSurfacesOrTablesToAFileToAnImage) {
  PredictJob predict;
  predict.field = make_rough({60, 45, 3}, 4, 9, 1);
  predict.input = path("heights.gsf");
  io::write_height_field(predict.input, predict.field);
  for (const LearnableKind& kind : learnable_kinds()) {
    SCOPED_TRACE(kind.name);
    const TrainSummary summary = train(kind, path(kind.name + ".json"));
    EXPECT_TRUE(summary.complete);
    EXPECT_EQ(summary.images_made, kind.needs_images ? 2 : 0);
    EXPECT_EQ(fs::exists(path(kind.name + ".training")), kind.needs_images);
    EXPECT_EQ(summary.model.record.notes.at("model"), kind.name);
    EXPECT_EQ(summary.model.record.notes.at("option.simulation.seed"), "1");
    EXPECT_EQ(summary.model.record.residuals.size(), kind.needs_images ? 2u : 0u);
    predict.model = path(kind.name + ".json");
    predict.outputs = {path(kind.name + ".exr")};
    run(predict);
    const Image image = io::read_image(predict.outputs.front());
    for (const char* channel : {"SE", "BSE"}) {
      ASSERT_NE(image.find(channel), nullptr);
      double sum = 0;
      for (const float value : image.find(channel)->values.data()) {
        ASSERT_TRUE(std::isfinite(value));
        sum += value;
      }
      // Secondaries of silicon at 1 keV: about 1 per primary; backscattered electrons a fifth of
      // that.
      const double mean = sum / static_cast<double>(image.find(channel)->values.size());
      EXPECT_GT(mean, channel[0] == 'S' ? 0.4 : 0.08) << channel;
      EXPECT_LT(mean, channel[0] == 'S' ? 2.5 : 0.7) << channel;
    }
  }
}

TEST_F(TrainEveryKind, GivesTheSameBytesWithAnyThreads) {
  for (const LearnableKind& kind : learnable_kinds()) {
    SCOPED_TRACE(kind.name);
    train(kind, path("one.json"));
    TrainJob job = job_of(kind, path("three.json"));
    job.simulation.threads = 3;
    run(job);
    EXPECT_EQ(bytes_of(path("one.json")), bytes_of(path("three.json")));
    fs::remove_all(path("one.training"));
    fs::remove_all(path("three.training"));
  }
}

TEST_F(TrainEveryKind, TheNetworkIsWhatIsLearntUnlessToldOtherwise) {
  EXPECT_EQ(LearnOptions{}.kind, "facet-network");
  EXPECT_EQ(learnable_kinds().front().name, LearnOptions{}.kind);
  const TrainSummary summary = train(kind("facet-network"), path("si.json"));
  const auto& p = std::get<FacetNetworkParameters>(summary.model.parameters);
  ASSERT_EQ(p.layers.size(), 2u);
  EXPECT_EQ(p.layers[0].outputs, 3);
  EXPECT_EQ(summary.model.record.notes.at("electron_range"), "31.77 nm");
  EXPECT_LE(std::stoi(summary.model.record.notes.at("iterations")), 30);
  EXPECT_THAT(summary.model.record.warnings, testing::Contains(HasSubstr("pixels are few")));
}

TEST_F(TrainEveryKind, LearningIsShownAndCanBeStoppedWhileImagesStay) {
  CancelToken token;
  Reporter listener;
  listener.cancel = &token;
  double most = 0;
  listener.on_progress = [&](double done, double total, std::string_view things) {
    if (!things.empty()) return;
    EXPECT_LE(done, total);
    most = std::max(most, done / total);
    if (most > 0.2) token.cancel();
  };
  const TrainJob job = job_of(kind("facet-network"), path("si.json"));
  const TrainSummary stopped = run(job, listener);
  EXPECT_FALSE(stopped.complete);
  EXPECT_GT(most, 0.2);
  EXPECT_LT(most, 1);
  EXPECT_FALSE(fs::exists(job.output));
  const TrainSummary again = run(job);
  EXPECT_EQ(again.images_found, 2);
  EXPECT_TRUE(fs::exists(job.output));
}

TEST_F(TrainEveryKind, ATableIsJudgedOnSurfacesButDoesNotLearnFromThem) {
  TrainJob job = job_of(kind("slope-table"), path("alone.json"));
  const auto alone = run(job).model;
  job.surfaces = 2;
  job.output = path("judged.json");
  const auto judged = run(job).model;
  EXPECT_EQ(std::get<SlopeModelParameters>(judged.parameters).channels.at(0).yields,
            std::get<SlopeModelParameters>(alone.parameters).channels.at(0).yields);
  EXPECT_TRUE(alone.record.scenes.empty());
  ASSERT_EQ(judged.record.scenes.size(), 2u);
  for (const TrainingScene& scene : judged.record.scenes) EXPECT_TRUE(scene.held_out);
  EXPECT_TRUE(judged.record.residuals.empty());
  ASSERT_EQ(judged.record.held_out_residuals.size(), 2u);
  EXPECT_EQ(judged.record.held_out_residuals[0].pixels, 512);
  EXPECT_EQ(judged.record.range, SurfaceRange{});
}

TEST_F(TrainEveryKind, StoppingPointsHaveTheYieldOfLevelGround) {
  TrainJob job = job_of(kind("stopping-points"), path("si.json"));
  job.learn.table_electrons = 4000;
  const auto model = make_model(run(job).model);
  HeightField level;
  level.z_nm = Grid<double>(4, 4);
  level.pitch_x_nm = level.pitch_y_nm = 3;
  EXPECT_NEAR(model->predict(level)[0](1, 1), 0.9, 0.1);
}

TEST_F(TrainEveryKind, RefusesWhatDoesNotConcernAKind) {
  const auto expect = [&](const char* name, const char* words, void (*spoil)(TrainJob&)) {
    TrainJob job = job_of(kind(name), path("si.json"));
    spoil(job);
    EXPECT_THAT([&] { run(job); }, testing::ThrowsMessage<UsageError>(HasSubstr(words))) << words;
  };
  expect("secant", "`training.hidden`: a model 'secant' has none",
         [](TrainJob& j) { j.learn.hidden = {4}; });
  expect("filter-bank", "`training.iterations`: a model 'filter-bank' has none",
         [](TrainJob& j) { j.learn.iterations = 4; });
  expect("filter-bank", "`training.decay`", [](TrainJob& j) { j.learn.decay = 0; });
  expect("slope-table", "`training.model_error`", [](TrainJob& j) { j.learn.model_error = 0; });
  expect("secant", "add `training.kind=slope-table`",
         [](TrainJob& j) { j.learn.table_electrons = 100; });
  expect("facet-network", "add `training.kind=filter-bank`",
         [](TrainJob& j) { j.learn.least_eigenvalue = 0; });
  expect("facet-network", "`training.hidden`: 0 is out of range",
         [](TrainJob& j) { j.learn.hidden = {0}; });
  expect("facet-network", "tolerance is 2", [](TrainJob& j) { j.learn.model_error = 2; });
  expect("slope-table", "`training.hold_out`", [](TrainJob& j) { j.surfaces = 2, j.held_out = 1; });
  expect("slope-table", "`training.table_electrons`: 1",
         [](TrainJob& j) { j.learn.table_electrons = 1; });
  expect("diffusion-matrix", "semsurf calibrate", [](TrainJob& j) { j.signal = "SE"; });
  expect("stopping-points", "knows of no spot", [](TrainJob& j) { j.spot_nm = 1; });
  expect("stopping-points", "continuous loss",
         [](TrainJob& j) { j.physics.loss = mc::LossModel::none; });
  EXPECT_FALSE(fs::exists(path("si.training")));
}

}  // namespace
}  // namespace surf::workflow
