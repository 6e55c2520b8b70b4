// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/train_job.h"

#include <gmock/gmock.h>

#include "small_job.h"
#include "small_training.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/stored_model.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class TrainJobTest : public testing::Test {
 protected:
  fs::path path(const char* name) const { return folder_.path() / name; }

  TrainSummary train(const TrainJob& job) {
    notes_.clear();
    Reporter listener;
    listener.on_note = [&](const std::string& note) { notes_.push_back(note); };
    return run(job, listener);
  }

  /// Writes an image that is twice 1 / cos of the slope of `field`, in the channels named.
  void write_image_of(const HeightField& field, const fs::path& file,
                      const std::vector<std::string>& channels) {
    const auto model = make_slope_model({}, {SlopeForm::secant, 5, {5, 0.6}, {{"x", 2, {}}}});
    const ModelImages images = model->predict(field);
    Image image;
    image.pitch_x_nm = image.pitch_y_nm = field.pitch_x_nm;
    for (const std::string& name : channels) {
      image.channels.push_back({name, "1", Grid<float>(field.z_nm.width(), field.z_nm.height())});
      for (std::size_t i = 0; i < images[0].size(); ++i)
        image.channels.back().values.data()[i] = static_cast<float>(images[0].data()[i]);
    }
    io::write_image(file, image);
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(TrainJobTest, MakesItsImagesAndAModelThatSaysWhereItIsFrom) {
  TrainJob job = small_training(path("si.json"));
  job.held_out = 1;
  const TrainSummary summary = train(job);
  EXPECT_TRUE(summary.complete);
  EXPECT_EQ(summary.images_made, 2);
  const TrainedModel model = io::read_model(path("si.json"));
  EXPECT_EQ(model.scope, (ModelScope{3, "Si", 1000, 0}));
  const TrainingRecord& record = model.record;
  ASSERT_EQ(record.scenes.size(), 2u);
  EXPECT_EQ(record.scenes[0].name, "blocks");
  EXPECT_FALSE(record.scenes[0].held_out);
  EXPECT_TRUE(record.scenes[1].held_out);
  EXPECT_EQ(record.scenes[1].electrons, 3);
  EXPECT_EQ(record.scenes[0].sha256.size(), 64u);
  ASSERT_EQ(record.residuals.size(), 2u);
  EXPECT_EQ(record.residuals[0].pixels, 256);
  EXPECT_GT(record.residuals[0].mean_signal, 0.3);
  EXPECT_EQ(record.held_out_residuals.size(), 2u);
  EXPECT_GT(record.range.slope_deg_max, 45);
  EXPECT_EQ(record.notes.at("model"), "secant");
  EXPECT_EQ(record.notes.at("option.simulation.seed"), "1");
  // Pixel on sample: what the simulator saw there is the surface.
  const Image image = io::read_image(path("si.training") / "blocks.exr");
  ASSERT_NE(image.find("z_nm"), nullptr);
  EXPECT_EQ(image.width(), 16);
  EXPECT_NEAR(image.origin_x_nm, -22.5, 1e-6);
}

TEST_F(TrainJobTest, GuidesImagesThatTeachAndNotThoseThatJudge) {
  TrainJob job = small_training(path("si.json"));
  job.held_out = 1;
  job.estimate = Estimate::guided;
  job.simulation.budget = mc::ElectronsPerPixel{16};
  const TrainSummary summary = train(job);
  const std::vector<TrainingScene>& scenes = summary.model.record.scenes;
  ASSERT_EQ(scenes.size(), 2u);
  for (const TrainingScene& scene : scenes) {
    const auto made = io::read_image(path("si.training") / (scene.name + ".exr")).metadata;
    EXPECT_EQ(made.at("simulation.estimate"), scene.held_out ? "plain" : "guided") << scene.name;
    EXPECT_EQ(made.contains("simulation.guided_by"), !scene.held_out);
  }
  job.learn.kind = "stopping-points";  // which no image teaches
  job.held_out = 0;
  job.output = path("table.json");
  train(job);
  for (const TrainingScene& scene : scenes)
    EXPECT_EQ(io::read_image(path("table.training") / (scene.name + ".exr"))
                  .metadata.at("simulation.estimate"),
              "plain");
}

TEST_F(TrainJobTest, UsesImagesThatAreThereAndGivesTheSameBytes) {
  const TrainJob job = small_training(path("si.json"));
  train(job);
  const std::string first = bytes_of(path("si.json"));
  EXPECT_EQ(train(job).images_found, 2);
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("2 of 2 images are there already")));
  EXPECT_EQ(bytes_of(path("si.json")), first);
  fs::remove(path("si.training") / "blocks.exr");
  EXPECT_EQ(train(job).images_made, 1);
  EXPECT_EQ(bytes_of(path("si.json")), first);
  TrainJob threads = job;
  threads.simulation.threads = 3;
  threads.output = path("again.json");
  train(threads);
  EXPECT_EQ(bytes_of(path("again.json")), first);
}

TEST_F(TrainJobTest, MakesImagesOfOtherSettingsAnew) {
  TrainJob job = small_training(path("si.json"));
  train(job);
  job.simulation.budget = mc::ElectronsPerPixel{2};
  EXPECT_EQ(train(job).images_made, 2);
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("2 images are there made otherwise")));
  job.energy_ev = 2000;
  EXPECT_EQ(train(job).images_found, 0);
  io::write_text(path("si.training") / "blocks.exr", "damaged");
  EXPECT_EQ(train(job).images_made, 1);
}

TEST_F(TrainJobTest, LearnsFurtherDetectorsAndSaysWhich) {
  TrainJob job = small_training(path("si.json"));
  job.learn.kind = "facet-network";
  job.learn.iterations = 4;
  job.detectors = mc::parse_detectors("quadrants", "test");
  const TrainedModel model = train(job).model;
  const auto& network = std::get<FacetNetworkParameters>(model.parameters);
  EXPECT_TRUE(network.sided);
  ASSERT_EQ(network.channels.size(), 6u);
  EXPECT_EQ(network.channels[2].name, "BSE-right");
  EXPECT_EQ(model.record.residuals.at(5).channel, "BSE-bottom");
  const std::vector<mc::Detector> taught = taught_by(io::read_model(path("si.json")));
  ASSERT_EQ(taught.size(), 4u);
  EXPECT_EQ(mc::format_detector(taught[1]), mc::format_detector(job.detectors[1]));

  job.detectors = mc::parse_detectors("in-lens", "test");
  EXPECT_FALSE(std::get<FacetNetworkParameters>(train(job).model.parameters).sided);
  job.learn.iterations.reset();
  const auto refused = [&](const char* kind, const char* what) {
    job.learn.kind = kind;
    EXPECT_THAT([&] { run(job); }, testing::ThrowsMessage<UsageError>(HasSubstr(what))) << kind;
  };
  refused("stopping-points", "gives SE and BSE only");
  job.detectors = mc::parse_detectors("side", "test");
  refused("filter-bank", "SE-side looks from a side");
  job.learn.kind = "secant";
  job.detectors = mc::parse_detectors("annular", "test");
  job.detectors.push_back(job.detectors.front());
  EXPECT_THROW(run(job), UsageError);
}

TEST_F(TrainJobTest, StopsAndGoesOnToTheSameBytes) {
  TrainJob job = small_training(path("si.json"));
  job.simulation.tile_pixels = 16;
  job.simulation.method = mc::Method::direct;
  train(job);
  const std::string undisturbed = bytes_of(path("si.json"));
  job.output = path("stopped.json");
  CancelToken token;
  Reporter listener;
  listener.cancel = &token;
  double most = 0;
  listener.on_progress = [&](double done, double total, std::string_view things) {
    if (things != "pixels") return;
    EXPECT_EQ(total, 512);
    EXPECT_GE(done, most);
    most = done;
    if (done > 300) token.cancel();
  };
  const TrainSummary stopped = run(job, listener);
  EXPECT_FALSE(stopped.complete);
  EXPECT_EQ(stopped.images_made, 1);
  EXPECT_FALSE(fs::exists(job.output));
  const TrainSummary resumed = train(job);
  EXPECT_TRUE(resumed.complete);
  EXPECT_EQ(resumed.images_found, 1);
  EXPECT_EQ(resumed.images_made, 1);
  EXPECT_EQ(bytes_of(job.output), undisturbed);
}

TEST_F(TrainJobTest, LearnsFromGivenImages) {
  TrainJob job = own_training(path("si.json"), 3);
  write_image_of(job.inputs[0].field, path("image.exr"), {"SE", "BSE"});
  job.inputs[0].image = path("image.exr");
  const TrainSummary summary = train(job);
  EXPECT_EQ(summary.images_made, 0);
  EXPECT_TRUE(summary.images.empty());
  EXPECT_FALSE(fs::exists(path("si.training")));
  const auto& p = std::get<SlopeModelParameters>(summary.model.parameters);
  EXPECT_NEAR(p.channels.at(1).flat_yield, 2, 1e-5);
  EXPECT_NEAR(summary.model.record.residuals[0].rms, 0, 1e-5);
  EXPECT_EQ(summary.model.record.scenes[0].name, "scan");
}

TEST_F(TrainJobTest, LearnsTheSameFromAnImageAsFromItsFile) {
  TrainJob job = own_training(path("si.json"), 3);
  job.inputs[0].name = "image.exr";  // the record names the image
  write_image_of(job.inputs[0].field, path("image.exr"), {"SE", "BSE"});
  job.inputs[0].image = path("image.exr");
  train(job);
  const std::string of_file = bytes_of(path("si.json"));
  job.inputs[0].image.clear();
  job.inputs[0].pixels = std::make_shared<Image>(io::read_image(path("image.exr")));
  EXPECT_EQ(train(job).images_made, 0);
  EXPECT_EQ(bytes_of(path("si.json")), of_file);
  Image narrow = *job.inputs[0].pixels;
  for (Channel& channel : narrow.channels) channel.values = Grid<float>(9, 16);
  job.inputs[0].pixels = std::make_shared<Image>(narrow);
  EXPECT_THAT([&] { train(job); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr("the image of image: it has 9 x 16")));
}

TEST_F(TrainJobTest, LearnsFromTheOneSignalOfAMicroscope) {
  TrainJob job = own_training(path("si.json"), 3);
  write_image_of(job.inputs[0].field, path("sem.tif"), {"InLens"});
  job.inputs[0].image = path("sem.tif");
  job.signal = "InLens";
  train(job);
  const auto model = make_model(io::read_model(path("si.json")));
  EXPECT_THAT(model->channels(), ElementsAre("signal"));
}

TEST_F(TrainJobTest, ResamplesFinerSurfacesAndRefusesCoarserOnes) {
  TrainJob job = own_training(path("si.json"), 2);
  job.pixel_nm = 3;
  train(job);
  EXPECT_THAT(notes_, testing::Contains(HasSubstr(
                          "16 x 16 samples of 2.00 nm are resampled to 11 x 11 of 3.00 nm")));
  EXPECT_EQ(io::read_model(path("si.json")).record.scenes[0].width, 11);
  job.pixel_nm = 0.9;
  EXPECT_THAT([&] { train(job); }, testing::ThrowsMessage<InvalidInput>(testing::AllOf(
                                       HasSubstr("2.00 nm apart"), HasSubstr("0.900 nm"))));
}

TEST_F(TrainJobTest, RefusesWhatCannotBeLearntBeforeTimeIsSpent) {
  const TrainJob good = own_training(path("si.json"), 3);
  const auto expect = [&](const char* words, void (*spoil)(TrainJob&)) {
    TrainJob job = good;
    spoil(job);
    EXPECT_THAT([&] { train(job); }, testing::ThrowsMessage<Error>(HasSubstr(words)));
  };
  expect("there is no kind 'neural'. Choose one of facet-network, filter-bank",
         [](TrainJob& j) { j.learn.kind = "neural"; });
  expect("training.least_eigenvalue", [](TrainJob& j) { j.learn.least_eigenvalue = 0.1; });
  expect("leave none to learn on", [](TrainJob& j) { j.held_out = 1; });
  expect("training.pixel_size", [](TrainJob& j) { j.pixel_nm = 0; });
  expect("there is no image of", [](TrainJob& j) { j.signal = "SE"; });
  expect("Name its HEIGHTS", [](TrainJob& j) {
    j.inputs.clear();
    j.surfaces = 2;
    j.signal = "SE";
  });
  expect(".json", [](TrainJob& j) { j.output = "model.txt"; });
  expect("missing samples", [](TrainJob& j) {
    j.inputs[0].field.valid = Mask(16, 16, 1);
    j.inputs[0].field.valid(3, 3) = 0;
  });
  EXPECT_FALSE(fs::exists(path("si.training")));
}

TEST_F(TrainJobTest, RefusesImagesThatDoNotFit) {
  TrainJob job = own_training(path("si.json"), 3);
  const HeightField small = make_rough({24, 24, 3}, 4, 9, 1);
  write_image_of(small, path("small.exr"), {"SE", "BSE"});
  job.inputs[0].image = path("small.exr");
  EXPECT_THAT([&] { train(job); }, testing::ThrowsMessage<InvalidInput>(testing::AllOf(
                                       HasSubstr("9 x 9 pixels"), HasSubstr("16 x 16 samples"))));
  write_image_of(job.inputs[0].field, path("se.exr"), {"SE"});
  job.inputs[0].image = path("se.exr");
  EXPECT_THAT([&] { train(job); },
              testing::ThrowsMessage<FileError>(HasSubstr("no channel 'BSE'")));
  HeightField other = job.inputs[0].field;
  other.pitch_x_nm = other.pitch_y_nm = 2;
  write_image_of(other, path("fine.exr"), {"SE", "BSE"});
  job.inputs[0].image = path("fine.exr");
  EXPECT_THAT([&] { train(job); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr("2.00 nm, the model's 3.00 nm")));
}

}  // namespace
}  // namespace surf::workflow
