// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/stored_model.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "heard.h"
#include "small_training.h"
#include "temporary_folder.h"
#include "training_time.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ModelRequest small_request(const fs::path& folder) {
  ModelRequest request;
  request.material = io::find_material("Si", "test");
  request.pixel_nm = 3;
  request.folder = folder;
  request.learn.iterations = 10;
  request.learn.hidden = std::vector<int>{3};
  request.surfaces = 6;
  request.surface_px = 16;
  request.electrons = 2;
  request.threads = 1;
  return request;
}

TEST(StoredModelTest, IsTrainedAfterANoteOfHowLongThatTakesAndKept) {
  const test::TemporaryFolder folder;
  const ModelRequest request = small_request(folder.path());
  test::Heard first, again;
  const StoredModel made = find_model(request, first.reporter());
  EXPECT_TRUE(made.made);
  ASSERT_GE(first.notes.size(), 2u);
  EXPECT_THAT(first.notes[0],
              HasSubstr("no model of Si at 1000 eV with pixels of 3.00 nm is kept"));
  EXPECT_THAT(first.notes[1], ContainsRegex("the training takes about [0-9]+ (s|minutes) more,"));
  EXPECT_EQ(made.trained.record.scenes.size(), 6u);
  const StoredModel kept = find_model(request, again.reporter());
  EXPECT_FALSE(kept.made);
  EXPECT_EQ(kept.sha256, made.sha256);
  EXPECT_THAT(again.notes, IsEmpty());
  // Its images are gone.
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    files.push_back(entry.path().filename());
  EXPECT_THAT(files, ElementsAre(kept_name(request)));
}

TEST(TrainingTime, IsMeasuredOnImagesThatTheTrainingGoesOnWith) {
  const test::TemporaryFolder folder;
  TrainJob job = small_training(folder.path() / "timed.json");
  job.surfaces = 6;
  EXPECT_GT(expected_training_s(job, {}), 0);
  const TrainSummary timed = run(job);
  EXPECT_EQ(timed.images_found, 4);
  EXPECT_EQ(timed.images_made, 2);
  job.output = folder.path() / "untimed.json";
  const TrainSummary untimed = run(job);
  EXPECT_EQ(untimed.images_found, 0);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(timed.model.record.scenes[i].residuals[0].rms,
              untimed.model.record.scenes[i].residuals[0].rms)
        << i;
}

}  // namespace
}  // namespace surf::workflow
