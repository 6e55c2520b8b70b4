// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>

#include "hilly_pair.h"
#include "seen_from.h"
#include "surf/core/error.h"
#include "surf/sem/facet_network.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/signal_detectors.h"

namespace surf::workflow {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// SE brightens with the slope, quadrants where the surface faces them.
TrainedModel quadrant_model() {
  FacetNetworkParameters p;
  p.scales = {{5, 0.6}};
  p.sided = true;
  const int inputs = network_inputs(p);
  DenseLayer layer{inputs, 0, {}, {}};
  const auto add = [&](const char* name, double steep, double east, double north) {
    p.channels.push_back({name, 0.2});
    std::vector<double> weights(static_cast<std::size_t>(inputs), 0.0);
    weights[0] = steep, weights[4] = east, weights[5] = north;
    layer.weights.insert(layer.weights.end(), weights.begin(), weights.end());
    layer.biases.push_back(0);
    ++layer.outputs;
  };
  add("SE", 2, 0, 0), add("BSE", 0.5, 0, 0);
  add("BSE-right", 0, -1, 0), add("BSE-top", 0, 0, -1);
  add("BSE-left", 0, 1, 0), add("BSE-bottom", 0, 0, 1);
  p.layers = {layer};
  TrainedModel model{{pitch, "Si", 1000, 0}, p, {}};
  model.record.range.slope_deg_max = 80;
  for (const mc::Detector& d : mc::parse_detectors("quadrants", "test")) {
    std::string& note = model.record.notes[detectors_note];
    note += (note.empty() ? "" : "; ") + mc::format_detector(d);
  }
  return model;
}

class ReconstructionOfQuadrants : public HillyPair {
 protected:
  ReconstructionOfQuadrants() {
    io::write_model(path("quadrants.json"), quadrant_model());
    job_.model.file = path("quadrants.json");
    job_.sem->image = image_of("SE", 1);
    job_.options.uncertainty = false;
  }

  PlacedImage image_of(const std::string& channel, std::uint64_t seed) const {
    const auto model = make_model(quadrant_model());
    const auto& names = model->channels();
    const auto c = std::ranges::find(names, channel) - names.begin();
    const Grid<double> all = model->predict(truth_)[static_cast<std::size_t>(c)];
    PlacedImage sem = job_.sem->image;
    const Grid<double> noise = simulate_noise({0, 4}, 50, 40, seed);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x) sem.values(x, y) = 300 * all(x + 12, y + 9) + 20 + noise(x, y);
    return sem;
  }
  SemInput view_of(const std::string& channel, std::uint64_t seed) const {
    SemInput view = *job_.sem;
    view.image = image_of(channel, seed);
    return view;
  }
  double error_nm(const ReconstructSummary& s) const {
    double n = 0, sum = 0, squares = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x) {
        const double off = s.result.surface.z_nm(x, y) - truth_.z_nm(x + 12, y + 9);
        ++n, sum += off, squares += off * off;
      }
    return std::sqrt(squares / n - sum * sum / n / n);
  }
};

TEST_F(ReconstructionOfQuadrants, TellWhichWayTheSurfaceFaces) {
  const double alone = error_nm(run(job_));
  job_.views = {view_of("BSE-right", 2), view_of("BSE-top", 3)};
  job_.view_settings.signals = {"BSE-right", "BSE-top"};
  const ReconstructSummary s = run(job_);
  ASSERT_EQ(s.result.views.size(), 2u);
  EXPECT_TRUE(s.views[0].model.sided);
  EXPECT_EQ(s.views[1].model.model->channels(), std::vector<std::string>{"BSE-top"});
  EXPECT_EQ(s.model->model->channels(), (std::vector<std::string>{"SE", "BSE"}));
  EXPECT_NEAR(s.result.views[0].gains.at(0), 300, 20);
  EXPECT_LT(error_nm(s), 0.7 * alone);
  const auto json = report("result");
  EXPECT_EQ(json["views"][0]["signal"], "BSE-right");
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--view-signal 'BSE-right;BSE-top'"));
}

TEST_F(ReconstructionOfQuadrants, ExchangedOnesAreRefused) {
  job_.views = {view_of("BSE-left", 2)};
  job_.view_settings.signals = {"BSE-right"};
  ReconstructSummary s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons, Contains(HasSubstr("looks like the image of BSE-left")));
  job_.view_settings.signals = {"BSE-bottom"};
  s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons, Contains(HasSubstr("looks like the image of BSE-left")));
  job_.view_settings.signals = {"BSE-left"};
  EXPECT_NE(run(job_).verdict, ReconstructionVerdict::not_registered);
}

TEST_F(ReconstructionOfQuadrants, FindHeightsWithoutAScan) {
  job_.afm.reset();
  job_.pose.transform.reset();
  job_.model.signal = "SE";
  job_.sem->image.origin_x_nm = 0;
  job_.calibration = GivenCalibration{{300}, 20};
  for (const char* signal : {"BSE-right", "BSE-top", "BSE-left", "BSE-bottom"}) {
    job_.views.push_back(view_of(signal, job_.views.size() + 2));
    job_.view_settings.signals.emplace_back(signal);
    job_.known_views.gains.push_back({300, 20});
  }
  job_.model_error = 0.01;
  job_.options.scales_px = {5, 1.4};
  const ReconstructSummary s = run(job_);
  double n = 0, sum = 0, squares = 0;
  for (int y = 9; y < 49; ++y)
    for (int x = 12; x < 62; ++x)
      ++n, sum += truth_.z_nm(x, y), squares += truth_.z_nm(x, y) * truth_.z_nm(x, y);
  EXPECT_LT(error_nm(s), 0.3 * std::sqrt(squares / n - sum * sum / n / n));
  for (const ViewResult& view : s.result.views) {
    EXPECT_LT(std::abs(view.pose.tilt_deg), 1e-4);  // of one scan: held
    EXPECT_EQ(view.gains.at(0), 300);               // nothing tells it from the heights
  }
  EXPECT_THAT(s.warnings, testing::Not(Contains(HasSubstr("begin flat"))));
  job_.known_views.gains.clear();
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr("view_gains")));
}

TEST_F(ReconstructionOfQuadrants, TheFirstImageMayBeOne) {
  job_.sem->image = image_of("BSE-top", 2);
  job_.model.signal = "BSE-top";
  ReconstructSummary s = run(job_);
  EXPECT_NE(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_EQ(s.result.gains.size(), 1u);
  EXPECT_THAT(report("result")["repeat"].get<std::string>(), HasSubstr("--signal BSE-top"));
  job_.model.signal = "BSE-bottom";
  s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons, Contains(HasSubstr("BSE-top")));
}

TEST_F(ReconstructionOfQuadrants, StandInTheImagesFrameHoweverTheScanIsTurned) {
  HeightField& scan = job_.afm->scan;
  HeightField turned = scan;
  const int w = scan.z_nm.width(), h = scan.z_nm.height();
  turned.z_nm = Grid<double>(h, w);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) turned.z_nm(h - 1 - y, x) = scan.z_nm(x, y);
  turned.valid = {};
  scan = turned;
  job_.pose.transform = Affine{0, -1, (h - 1) * pitch - 45, 1, 0, 60};
  job_.sem->image = image_of("BSE-top", 2);
  job_.model.signal = "BSE-top";
  const ReconstructSummary told = run(job_);
  EXPECT_NE(told.verdict, ReconstructionVerdict::not_registered);
  EXPECT_GT(correlation_at(job_.sem->image, told.pose->simulated, told.pose->sem_to_afm), 0.5);
  job_.model.signal = "BSE-right";
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::not_registered);
  EXPECT_THAT(s.reasons, Contains(HasSubstr("looks like the image of BSE-top")));
  // Searched for, the turn is found by SE, then by what is told.
  job_.pose.transform.reset();
  job_.pose.accept_unverified = true;
  job_.model.signal = "BSE-top";
  const Pose found = *run(job_).pose;
  const Affine map = found.sem_to_afm;
  EXPECT_GT(correlation_at(job_.sem->image, found.simulated, map), 0.5);
  EXPECT_NEAR(map.yx, 1, 0.1);
  EXPECT_NEAR(map.xy, -1, 0.1);
}

TEST_F(ReconstructionOfQuadrants, AModelOfADetectorOfThatNameMayBeOfAnother) {
  const auto refused = [&](const char* what) {
    EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr(what)));
  };
  job_.model.signal = "BSE-right:cone=0deg..30deg";
  refused("reconstruction.signal");
  job_.model.signal.clear();
  job_.film = "SiO2";
  job_.calibration = GivenCalibration{{300, 300}, 20};
  job_.views = {view_of("BSE-left", 2)};
  job_.view_settings.signals = {"BSE-left"};
  refused("reconstruction.film");
}

TEST_F(ReconstructionOfQuadrants, AListMayBeginWithTheFirstImage) {
  job_.sem->image = image_of("BSE-top", 2);
  job_.views = {view_of("BSE-left", 3)};
  job_.view_settings.signals = {"BSE-top", "BSE-left"};
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(s.model->model->channels(), std::vector<std::string>{"BSE-top"});
  EXPECT_EQ(s.views.at(0).signal, "BSE-left");
}

TEST_F(ReconstructionOfQuadrants, SignalsThatNoModelKnowsAreRefused) {
  const auto refused = [&](const char* what) {
    EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr(what)));
  };
  job_.model.signal = "side";
  refused("knows SE, BSE, BSE-right");
  job_.model.signal = "CL";
  refused("reconstruction.signal");
  job_.model.signal.clear();
  job_.views = {view_of("BSE-left", 2)};
  job_.model.signal = "BSE-top";
  job_.view_settings.signals = {"BSE-left", "BSE-left"};
  refused("of the first SEM image");
  job_.model.signal.clear();
  job_.view_settings.signals = {"CL"};
  refused("reconstruction.signal");
}

TEST(SignalDetectors, OneModelServesAllQuadrants) {
  EXPECT_TRUE(detectors_of("SE", "test").empty());
  EXPECT_EQ(detectors_of("BSE-top", "test").at(0).name, "BSE-top");
  EXPECT_EQ(taught_detectors("BSE-top", "test").size(), 4u);
  EXPECT_EQ(taught_detectors("in-lens", "test").size(), 1u);
  EXPECT_EQ(channel_of("side", "test"), "SE-side");
  EXPECT_EQ(channel_of("BSE", "test"), "BSE");
  ModelRequest right, top, none;
  right.material.name = top.material.name = none.material.name = "Si";
  right.signal = "BSE-right", top.signal = "BSE-top";
  EXPECT_EQ(kept_name(right), kept_name(top));
  EXPECT_NE(kept_name(right), kept_name(none));
}

}  // namespace
}  // namespace surf::workflow
