// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "hilly_pair.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/reconstruction/view.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A second image of the pair's place, seen from the side.
class ReconstructionOfViews : public HillyPair {
 protected:
  static constexpr double tilt_deg = 12;

  ReconstructionOfViews() {
    job_.views.push_back(seen_from(0));
    job_.view_settings.tilts_deg = {tilt_deg};
    job_.options.uncertainty = false;
  }

  /// By the heights along the beam, in the SEM image's frame, displaced by two pixels.
  SemInput seen_from(double azimuth_deg) const {
    HeightField truth = truth_;
    truth.origin_x_nm = -shift.x0, truth.origin_y_nm = -shift.y0;
    SemInput view = *job_.sem;
    view.file = job_.sem->file;
    const ViewPose pose{tilt_deg, azimuth_deg, {1, 0, 2 * pitch, 0, 1, 0}};
    HeightField along = heights_along_beam(truth, view.image, pose);
    along.valid = {};
    const ModelImages seen = model().model->predict(along);
    const Grid<double> noise = simulate_noise({0, 4}, 50, 40, 10);
    for (std::size_t i = 0; i < noise.size(); ++i)
      view.image.values.data()[i] =
          100 * seen[0].data()[i] + 100 * seen[1].data()[i] + 20 + noise.data()[i];
    return view;
  }
};

TEST_F(ReconstructionOfViews, FindsWhereAViewLooksAndWritesIt) {
  const ReconstructSummary s = run(job_);
  ASSERT_EQ(s.result.views.size(), 1u);
  EXPECT_NEAR(s.views[0].shift_x_nm, 2 * pitch, 1.01 * pitch);
  EXPECT_GT(s.views[0].correlation, 0.8);
  EXPECT_NEAR(s.result.views[0].pose.tilt_deg, tilt_deg, 1.5);
  EXPECT_NEAR(s.result.views[0].pose.to_plane.x0, 2 * pitch, pitch);
  EXPECT_TRUE(std::filesystem::exists(job_.folder / "simulated_sem2.vti"));
  EXPECT_FALSE(std::filesystem::exists(job_.folder / "model2.json"));  // it is the first one's
  const auto json = report("result");
  EXPECT_EQ(json["views"][0]["tilt_deg"], tilt_deg);
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--tilt 12"));
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--view-place"));

  // What the report says makes the same surface again.
  ReconstructJob again = job_;
  again.folder = path("again");
  again.known_views.gains = {s.views[0].gains};
  again.known_views.gains[0].push_back(s.views[0].offset);
  again.known_views.noises = {s.views[0].noise};
  again.known_views.places_nm = {{s.views[0].shift_x_nm, s.views[0].shift_y_nm}};
  EXPECT_EQ(run(again).result.surface.z_nm, s.result.surface.z_nm);
}

TEST_F(ReconstructionOfViews, AnotherViewBeginsAnewAndTheSameGoesOn) {
  run(job_);
  const std::string wanted = io::read_file(job_.folder / "surface.vti");
  ReconstructJob other = job_;
  other.views[0] = seen_from(90);
  other.view_settings.azimuths_deg = {90};
  run(other);
  EXPECT_NE(io::read_file(job_.folder / "surface.vti"), wanted);
  run(job_);
  EXPECT_EQ(io::read_file(job_.folder / "surface.vti"), wanted);
}

TEST_F(ReconstructionOfViews, AViewOfAnotherPlaceIsRefused) {
  for (std::size_t i = 0; i < job_.views[0].image.values.size(); ++i)
    job_.views[0].image.values.data()[i] = 120 + 30 * std::sin(78.233 * double(i) * double(i));
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons.at(0), HasSubstr("view 2"));
}

TEST_F(ReconstructionOfViews, AViewOfTheOtherSideIsRefused) {
  job_.views[0] = seen_from(180);
  const ReconstructSummary s = run(job_);
  EXPECT_GT(s.views[0].other_side, s.views[0].correlation);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons.at(0), HasSubstr("beam.azimuth"));
}

TEST_F(ReconstructionOfViews, ListsThatDoNotFitTheImagesAreRefused) {
  const auto refused = [&](const char* what) {
    EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr(what)));
  };
  job_.view_settings.tilts_deg = {1, 2, 3};
  refused("beam.tilt");
  job_.view_settings.tilts_deg = {5, 12};
  refused("straight down");
  job_.view_settings.tilts_deg = {70};
  refused("out of range");
  job_.view_settings.tilts_deg = {12};
  job_.known_views.gains = {{1}, {2}};
  refused("view_gains");
  job_.known_views.gains = {{1}};
  refused("view_gains");
  job_.known_views = {};
  job_.sem.reset();
  refused("reconstruction.sem");
}

}  // namespace
}  // namespace surf::workflow
