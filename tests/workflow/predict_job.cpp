// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/predict_job.h"

#include <gmock/gmock.h>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/mesh/shapes.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class PredictJobTest : public testing::Test {
 protected:
  PredictJobTest() {
    TrainedModel model;
    model.scope = {3, "Si", 1000, 0};
    model.parameters =
        SlopeModelParameters{SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}, {"BSE", 0.2, {}}}};
    model.record.range.slope_deg_max = 80;
    io::write_model(path("si.json"), model);
    job_.model = path("si.json");
    job_.input = path("heights.gsf");
    job_.field = make_rough({60, 45, 3}, 4, 9, 1);
    io::write_height_field(job_.input, job_.field);
    job_.outputs = {path("image.exr")};
  }

  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  test::TemporaryFolder folder_;
  PredictJob job_;
};

TEST_F(PredictJobTest, WritesWhatTheModelPredictsAndWhichMadeIt) {
  const PredictSummary summary = run(job_);
  EXPECT_THAT(summary.warnings, IsEmpty());
  const Image image = io::read_image(path("image.exr"));
  const auto predicted = make_model(io::read_model(job_.model))->predict(job_.field);
  ASSERT_NE(image.find("BSE"), nullptr);
  for (std::size_t i = 0; i < predicted[1].size(); ++i)
    ASSERT_EQ(image.find("BSE")->values.data()[i], static_cast<float>(predicted[1].data()[i]));
  EXPECT_EQ(image.pitch_x_nm, 3);
  EXPECT_NEAR(image.origin_x_nm, job_.field.origin_x_nm, 1e-6);
  EXPECT_THAT(image.metadata.at("model"),
              HasSubstr("si.json sha256 " + io::sha256_of_file(job_.model)));
  EXPECT_THAT(image.metadata.at("input.1"), HasSubstr("heights.gsf sha256 "));
  const std::string first = bytes_of(path("image.exr"));
  job_.threads = 3;
  run(job_);
  EXPECT_EQ(bytes_of(path("image.exr")), first);
}

TEST_F(PredictJobTest, WritesEveryFormat) {
  job_.outputs = {path("a.tif"), path("a.vti"), path("a.png")};
  job_.png_channel = "BSE";
  run(job_);
  for (const auto& output : job_.outputs) EXPECT_EQ(io::read_image(output).width(), 21) << output;
}

TEST_F(PredictJobTest, RefusesAnotherPixelSizeMaterialEnergyOrSpot) {
  PredictJob other = job_;
  other.field = make_rough({40, 30, 2}, 4, 9, 1);
  EXPECT_THAT([&] { run(other); },
              testing::ThrowsMessage<InvalidInput>(testing::AllOf(HasSubstr("2"), HasSubstr("3"))));
  for (const ModelScope& wanted :
       {ModelScope{0, "Au", 0, 0}, ModelScope{0, "", 2000, 0}, ModelScope{0, "", 0, 1}}) {
    other = job_;
    other.wanted = wanted;
    EXPECT_THROW(run(other), UsageError);
  }
  EXPECT_FALSE(std::filesystem::exists(path("image.exr")));
  job_.wanted = {0, "Si", 1000, 0};
  EXPECT_NO_THROW(run(job_));
}

TEST_F(PredictJobTest, ResamplesWhereItIsAsked) {
  job_.field = make_rough({40, 30, 2}, 4, 9, 1);
  job_.resample = true;
  std::string said;
  run(job_, {.on_note = [&](const std::string& note) { said = note; }});
  EXPECT_THAT(said, HasSubstr("21 x 16 samples of 2.00 nm are resampled to 14 x 11 of 3.00 nm"));
  EXPECT_EQ(io::read_image(path("image.exr")).width(), 14);
}

TEST_F(PredictJobTest, WarnsOfSlopesThatWereNotLearnt) {
  job_.field = make_step({60, 45, 3}, 400, 0);
  EXPECT_THAT(run(job_).warnings, testing::ElementsAre(HasSubstr("steeper than the 80 degrees")));
}

TEST_F(PredictJobTest, KeepsTheImageWhereNoFileIsWanted) {
  run(job_);
  PredictJob job = job_;
  job.outputs.clear();
  const Image image = run(job).image, written = io::read_image(path("image.exr"));
  ASSERT_EQ(image.channels.size(), written.channels.size());
  for (const Channel& channel : image.channels)
    EXPECT_EQ(channel.values.data(), written.find(channel.name)->values.data()) << channel.name;
  EXPECT_EQ(image.metadata.at("model"), written.metadata.at("model"));
}

TEST_F(PredictJobTest, RefusesBadOutputs) {
  job_.png_channel = "gold";
  job_.outputs = {path("a.png")};
  EXPECT_THROW(run(job_), UsageError);
  job_.png_channel.clear();
  job_.outputs = {path("a.exr"), path("a.exr")};
  EXPECT_THROW(run(job_), UsageError);
}

}  // namespace
}  // namespace surf::workflow
