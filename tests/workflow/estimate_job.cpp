// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/estimate_job.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

SimulateJob counted_job() {
  SimulateJob job = small_job();
  job.scene.scan.width = 24;
  job.scene.scan.height = 20;
  job.scene.scan.pixel_x_nm = job.scene.scan.pixel_y_nm = 4;
  job.scene.method = mc::Method::direct;
  job.scene.beam.tilt_deg = 20;
  job.scene.budget = mc::ElectronsPerPixel{33};
  job.scene.detectors = mc::parse_detectors("side:efficiency=0.5", "test");
  job.extras.channels = {"counts", "electrons", "z_nm", "normal", "material"};
  return job;
}

TEST(EstimateJob, MakesOfCountsWhatSimulateMakesAtOnce) {
  const TemporaryFolder folder;
  SimulateJob job = counted_job();
  job.outputs = {folder.path() / "plain.exr"};
  run(job);
  job.estimate.kind = Estimate::guided;
  job.outputs = {folder.path() / "guided.exr"};
  run(job);
  EstimateJob estimate;
  estimate.input = folder.path() / "plain.exr";
  estimate.outputs = {folder.path() / "estimated.exr"};
  const EstimateSummary done = run(estimate);
  EXPECT_THAT(done.detectors, testing::ElementsAre("SE", "BSE", "SE-side"));
  EXPECT_THAT(done.guides, testing::Contains("sky"));
  const Image at_once = io::read_image(folder.path() / "guided.exr"),
              after = io::read_image(folder.path() / "estimated.exr");
  for (const std::string& detector : done.detectors)
    for (const char* ending : {"", ".stderr"})
      for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x)
          // Heights and normals are in single precision either way.
          ASSERT_NEAR(after.find(detector + ending)->values(x, y),
                      at_once.find(detector + ending)->values(x, y), 1e-5)
              << detector << ending;
  EXPECT_EQ(after.metadata.at("simulation.estimate"), "guided");
  // With the detectors' efficiency, as plain yields have it.
  const Image plain = io::read_image(folder.path() / "plain.exr");
  for (const std::string& detector : done.detectors) {
    double guided = 0, counted = 0;
    for (const float value : after.find(detector)->values.data()) guided += value;
    for (const float value : plain.find(detector)->values.data()) counted += value;
    EXPECT_NEAR(guided / counted, 1, 0.05) << detector;
  }
}

TEST(EstimateJob, RefusesWhatNoSimulationWrites) {
  const TemporaryFolder folder;
  SimulateJob job = counted_job();
  job.outputs = {folder.path() / "plain.exr"};
  run(job);
  const Image good = io::read_image(job.outputs[0]);
  const auto said_of = [&](const std::function<void(Image&)>& change) {
    EstimateJob estimate;
    estimate.image = good;
    change(estimate.image);
    try {
      run(estimate);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto pixel = [](const char* channel, float value) {
    return [=](Image& image) {
      for (Channel& c : image.channels)
        if (c.name == channel) c.values(3, 4) = value;
    };
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(said_of(pixel("SE.sum", -1)), HasSubstr("SE.sum"));
  EXPECT_THAT(said_of(pixel("electrons", nan)), HasSubstr("electrons"));
  EXPECT_THAT(said_of(pixel("BSE.odd_squares", 1e30f)), HasSubstr("BSE.odd_squares"));
  EXPECT_THAT(said_of(pixel("material", nan)), HasSubstr("material"));
  EXPECT_THAT(said_of(pixel("z_nm", nan)), HasSubstr("guide"));
  EXPECT_THAT(said_of([](Image& image) { image.metadata["beam.tilt_deg"] = "95"; }),
              HasSubstr("tilt"));
}

TEST(EstimateJob, IsGuidedByAnyChannelOrByNeighboursAlone) {
  const TemporaryFolder folder;
  SimulateJob job = counted_job();
  job.extras.channels = {"counts", "electrons"};
  job.outputs = {folder.path() / "plain.exr"};
  run(job);
  EstimateJob estimate;
  estimate.input = job.outputs[0];
  EXPECT_THAT(run(estimate).guides, testing::IsEmpty());
  estimate.guides = {"BSE"};
  EXPECT_THAT(run(estimate).guides, testing::ElementsAre("BSE"));
  estimate.guides = {"TSE"};
  EXPECT_THAT([&] { run(estimate); }, testing::ThrowsMessage<UsageError>(HasSubstr("'TSE'")));
}

TEST(EstimateJob, RefusesAnImageWithoutCounts) {
  const TemporaryFolder folder;
  SimulateJob job = counted_job();
  job.extras.channels = {};
  job.outputs = {folder.path() / "plain.exr"};
  run(job);
  EstimateJob estimate;
  estimate.input = job.outputs[0];
  EXPECT_THAT([&] { run(estimate); }, testing::ThrowsMessage<InvalidInput>(HasSubstr("no counts")));
}

}  // namespace
}  // namespace surf::workflow
