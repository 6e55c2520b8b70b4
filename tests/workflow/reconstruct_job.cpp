// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/reconstruct_job.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "hilly_pair.h"
#include "small_job.h"
#include "surf/afm/morphology.h"
#include "surf/afm/round_tip.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/tip_file.h"
#include "surf/mesh/shapes.h"
#include "surf/sem/slope_model.h"
#include "surf/workflow/simulate_job.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

class ReconstructJobTest : public HillyPair {};

/// Ends the run once a scale is done.
Reporter stopping(CancelToken& token, const std::filesystem::path& checkpoint) {
  Reporter listener;
  listener.cancel = &token;
  // Parts of the work have copies of this.
  listener.on_progress = [&token, checkpoint, first = std::make_shared<std::uintmax_t>(0)](
                             double, double, std::string_view) {
    std::error_code none;
    const auto size = std::filesystem::file_size(checkpoint, none);
    if (!none && *first == 0) *first = size;
    if (!none && size > *first + 10000) token.cancel();
  };
  return listener;
}

TEST_F(ReconstructJobTest, FindsTheSurfaceAndSaysHow) {
  HeightField truth = truth_;
  truth.origin_x_nm = -shift.x0, truth.origin_y_nm = -shift.y0;  // in the SEM's frame
  job_.truth = truth;
  job_.truth_file = path("scan.txt");
  job_.model_error = 0.03;
  const ReconstructSummary s = run(job_);
  ASSERT_TRUE(s.truth.has_value());
  EXPECT_LT(s.truth->rms_nm, s.truth->start_rms_nm);
  for (const char* name :
       {"surface.vti", "surface.gsf", "surface.glb", "simulated_afm.vti", "simulated_sem.vti",
        "history.csv", "transform.json", "tip.txt", "model.json", "report.json"})
    EXPECT_THAT(s.written, Contains(job_.folder / name));
  EXPECT_FALSE(std::filesystem::exists(job_.folder / "checkpoint"));
  const auto json = report("result");
  EXPECT_EQ(json["sem"]["noise"]["intercept"], 4);
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--transform 1,0,60,0,1,45"));
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--model-error 3%"));
  EXPECT_EQ(json["scales"].size(), 2u);
}

TEST_F(ReconstructJobTest, GoesOnToTheSameBytes) {
  run(job_);
  const std::string wanted = io::read_file(job_.folder / "surface.vti");
  job_.folder = path("stopped");
  CancelToken token;
  EXPECT_THROW(run(job_, stopping(token, job_.folder / "checkpoint")), Interrupted);
  ASSERT_TRUE(std::filesystem::exists(job_.folder / "checkpoint"));
  const ReconstructSummary s = run(job_);
  EXPECT_TRUE(s.resumed);
  EXPECT_EQ(io::read_file(job_.folder / "surface.vti"), wanted);
  EXPECT_EQ(io::read_file(job_.folder / "history.csv"),
            io::read_file(path("result") / "history.csv"));
}

/// The SEM image is by Monte Carlo, which the model of 1 / cos knows badly.
class CorrectedReconstruction : public ReconstructJobTest {
 protected:
  CorrectedReconstruction() {
    SimulateJob simulation;
    simulation.scene.specimen.materials = {io::find_material("Si", "test")};
    simulation.scene.specimen.height_field = mc::HeightFieldBody{"truth", truth_, 0, Edge::mirror};
    simulation.scene.beam.energy_ev = 1000;
    simulation.scene.scan.width = 50, simulation.scene.scan.height = 40;
    simulation.scene.scan.region =
        mc::ScanRequest::Region{shift.x0 - 0.5 * pitch, shift.y0 - 0.5 * pitch,
                                shift.x0 + 49.5 * pitch, shift.y0 + 39.5 * pitch};
    simulation.scene.budget = mc::ElectronsPerPixel{200};
    simulation.execution.threads = 1;
    const SimulateSummary done = run(simulation);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x)
        job_.sem->image.values(x, y) =
            100 * done.result.yield(0, x, y).mean + 100 * done.result.yield(1, x, y).mean + 20;
    job_.calibration = {{100, 100}, 20};
    job_.options.refine_calibration = false;
    job_.sem_noise = SemNoise{0, 60, 1e-3};
    job_.truth = truth_;
    job_.truth->origin_x_nm = -shift.x0, job_.truth->origin_y_nm = -shift.y0;
    job_.truth_file = path("scan.txt");
    job_.correction_electrons = 16;
    job_.options.scales_px = {1};
    job_.options.uncertainty = false;
  }
};

TEST_F(CorrectedReconstruction, MonteCarloPutsAWrongModelRight) {
  const double wrong = run(job_).truth->rms_nm;
  job_.corrections = 1;
  const ReconstructSummary s = run(job_);
  EXPECT_LT(s.truth->rms_nm, 0.9 * wrong);
  ASSERT_FALSE(s.corrections.empty());
  EXPECT_GT(s.corrections[0].off_share[0], 0.05);
  EXPECT_LT(s.corrections[0].error_share[0], 0.7 * s.corrections[0].off_share[0]);
  EXPECT_EQ(s.corrections[0].primaries, 16 * 50 * 40);
  EXPECT_GT(s.corrections[0].moved_nm, 0.1);
  const auto json = report("result");
  EXPECT_EQ(json["corrections"].size(), s.corrections.size());
  EXPECT_THAT(json["repeat"].get<std::string>(), HasSubstr("--corrections 1"));
}

TEST_F(CorrectedReconstruction, GoesOnInTheMiddleOfItsRounds) {
  job_.corrections = 2;
  run(job_);
  const std::string wanted = io::read_file(job_.folder / "surface.vti");
  job_.folder = path("stopped");
  CancelToken token;
  Reporter listener;
  listener.cancel = &token;
  listener.on_note = [&](const std::string& note) {
    if (note.find("Monte Carlo corrects") != std::string::npos) token.cancel();
  };
  EXPECT_THROW(run(job_, listener), Interrupted);
  const ReconstructSummary s = run(job_);
  EXPECT_TRUE(s.resumed);
  EXPECT_EQ(io::read_file(job_.folder / "surface.vti"), wanted);
}

TEST_F(CorrectedReconstruction, AFilmThatIsNotThereHasNoThickness) {
  job_.film = "SiO2";
  job_.corrections = 1;
  const ReconstructSummary s = run(job_);
  EXPECT_LT(s.result.film_nm, 0.5);
  EXPECT_EQ(s.result.gains, job_.calibration->gains);
  const auto film = report("result")["sem"]["film"];
  EXPECT_EQ(film["material"], "SiO2");
  EXPECT_EQ(film["thickness_nm"], s.result.film_nm);
  EXPECT_GT(film["relative_change_per_nm"][0][0], 0);
  EXPECT_THAT(report("result")["repeat"].get<std::string>(), HasSubstr("--film SiO2"));
}

TEST_F(CorrectedReconstruction, AFilmThatWouldBeTooThickIsDoubted) {
  job_.film = "SiO2";
  job_.calibration = {{20, 20}, 20};  // a fifth of the true gains
  job_.corrections = 0;
  job_.options.uncertainty = false;
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(s.result.film_nm, largest_film_nm);
  EXPECT_THAT(s.reasons, Contains(HasSubstr("thicker than the 5.00 nm")));
}

TEST_F(ReconstructJobTest, AFilmNeedsKnownGainsAndAKnownMaterial) {
  job_.film = "SiO2";
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr("reconstruction.gains")));
  job_.calibration = {{100, 100}, 20};
  job_.film = "unobtainium";
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr("unobtainium")));
  job_.film = "SiO2";
  TrainedModel model = io::read_model(path("si.json"));
  model.scope.material = "somebody's own";
  io::write_model(path("si.json"), model);
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr("models of SE and BSE")));
}

TEST_F(ReconstructJobTest, ModelsOfOtherSignalsAreNotCorrected) {
  TrainedModel model = io::read_model(path("si.json"));
  model.scope.material = "somebody's own";
  io::write_model(path("si.json"), model);
  job_.corrections = 2;
  EXPECT_THAT(run(job_).corrections, IsEmpty());
}

TEST_F(ReconstructJobTest, ATiltThatIsGivenIsAddedToTheScan) {
  const ReconstructSummary level = run(job_);
  job_.tilt = SemTilt{0.002, 0, {1e-4, 1e-4}};
  const ReconstructSummary s = run(job_);
  const Grid<double>&before = level.afm->image.z_nm, &after = s.afm->image.z_nm;
  EXPECT_NEAR(after(60, 40) - before(60, 40) - (after(40, 40) - before(40, 40)), 0.002 * 20 * pitch,
              1e-9);
  EXPECT_EQ(s.afm->level_doubt.x, 1e-4);
  EXPECT_THAT(report("result")["repeat"].get<std::string>(),
              HasSubstr("--scan-tilt 0.002,0,1e-04,1e-04"));
}

TEST_F(ReconstructJobTest, TheTipIsFittedWhereItWasFoundBlindlyOrAsked) {
  ReconstructSummary s;
  s.afm.emplace();
  EXPECT_TRUE(options_of(job_, s).refine_tip);
  s.afm->tip_given = true;
  EXPECT_FALSE(options_of(job_, s).refine_tip);
  job_.refine_tip = true;
  EXPECT_TRUE(options_of(job_, s).refine_tip);
  job_.options.method = ReconstructionMethod::lbfgs;
  EXPECT_FALSE(options_of(job_, s).refine_tip);
  job_.options.method = ReconstructionMethod::gauss_newton;
  job_.sem.reset();
  EXPECT_FALSE(options_of(job_, s).refine_tip);
}

TEST_F(ReconstructJobTest, AFittedTipIsWrittenAndFoundAgain) {
  for (double& z : job_.afm->preparation.tip->z_nm.data()) z *= 0.7;
  job_.refine_tip = true;
  const ReconstructSummary s = run(job_);
  for (const char* name : {"tip.txt", "first_tip.txt"})
    EXPECT_THAT(s.written, Contains(job_.folder / name));
  const Tip first = io::read_tip(job_.folder / "first_tip.txt"),
            last = io::read_tip(job_.folder / "tip.txt");
  EXPECT_EQ(first.z_nm, s.afm->tip.z_nm);
  EXPECT_EQ(last.z_nm, s.result.tip.z_nm);
  EXPECT_NE(last.z_nm, first.z_nm);
  const auto tip = report("result")["afm"]["tip"];
  EXPECT_EQ(tip["fitted"], true);
  EXPECT_EQ(tip["profile_step_nm"], pitch);
  EXPECT_EQ(tip["profile_nm"][3], round_profile_nm(first, 0.5)[3]);
  EXPECT_EQ(tip["profile_at_the_end_nm"][3], round_profile_nm(last, 0.5)[3]);
  EXPECT_THAT(report("result")["repeat"].get<std::string>(),
              AllOf(HasSubstr("first_tip.txt "), HasSubstr(" --refine-tip ")));
  // As the report says it is repeated: begun with the first tip.
  ReconstructJob again = job_;
  again.afm->preparation.tip = first;
  again.calibration = {s.calibration->gains, s.calibration->offset};
  again.options.refine_calibration = options_of(job_, s).refine_calibration;
  again.folder = path("again");
  run(again);
  EXPECT_EQ(io::read_file(path("again") / "surface.vti"),
            io::read_file(job_.folder / "surface.vti"));
  EXPECT_EQ(io::read_file(path("again") / "tip.txt"), io::read_file(job_.folder / "tip.txt"));
  // Stopped after a scale, it goes on with the tip of that scale.
  again.folder = path("stopped");
  CancelToken token;
  EXPECT_THROW(run(again, stopping(token, again.folder / "checkpoint")), Interrupted);
  EXPECT_TRUE(run(again).resumed);
  EXPECT_EQ(io::read_file(path("stopped") / "surface.vti"),
            io::read_file(job_.folder / "surface.vti"));
  EXPECT_EQ(io::read_file(path("stopped") / "tip.txt"), io::read_file(job_.folder / "tip.txt"));
}

TEST_F(ReconstructJobTest, AKeptTipIsWrittenOnce) {
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(io::read_tip(job_.folder / "tip.txt").z_nm, s.afm->tip.z_nm);
  EXPECT_FALSE(std::filesystem::exists(job_.folder / "first_tip.txt"));
  EXPECT_EQ(report("result")["afm"]["tip"]["fitted"], false);
  EXPECT_FALSE(report("result")["afm"]["tip"].contains("profile_at_the_end_nm"));
  EXPECT_THAT(report("result")["repeat"].get<std::string>(),
              AllOf(HasSubstr("/tip.txt "), HasSubstr(" --keep-tip ")));
}

TEST_F(ReconstructJobTest, DoesNotGoOnWithAnotherJob) {
  CancelToken token;
  EXPECT_THROW(run(job_, stopping(token, job_.folder / "checkpoint")), Interrupted);
  job_.options.tolerance = 0.002;
  std::string said;
  Reporter listener;
  listener.on_note = [&](const std::string& note) { said += note + "\n"; };
  EXPECT_FALSE(run(job_, listener).resumed);
  EXPECT_THAT(said, HasSubstr("optimiser_tolerance"));
}

TEST_F(ReconstructJobTest, AnyOtherInputBeginsAnew) {
  const auto checkpoint = job_.folder / "checkpoint";
  job_.calibration = {{100, 100}, 20};
  CancelToken first;
  EXPECT_THROW(run(job_, stopping(first, checkpoint)), Interrupted);
  const std::function<void(ReconstructJob&)> changes[] = {
      [](ReconstructJob& j) { j.afm->preparation.noise->innovation_nm2 *= 1.01; },
      [](ReconstructJob& j) { j.afm->preparation.tip->z_nm(0, 0) -= 1; },
      [](ReconstructJob& j) { j.afm->scan.z_nm(9, 9) += 0.01; },
      [](ReconstructJob& j) { j.upsample = 2; },
      [](ReconstructJob& j) { j.refine_tip = true; },
      [](ReconstructJob& j) { j.sem->image.values(3, 3) += 1; },
      [](ReconstructJob& j) { j.sem_noise->intercept = 5; },
      [](ReconstructJob& j) { j.calibration->offset = 21; },
      [](ReconstructJob& j) { j.calibration->gains[1] = 90; },
      [](ReconstructJob& j) { j.pose.transform->x0 += 1; },
      [](ReconstructJob& j) { j.tilt->x = 1e-4; },
      [](ReconstructJob& j) { j.corrections = 1; },
      [](ReconstructJob& j) { j.options.curvature_prior_per_nm = 0.01; },
      [](ReconstructJob& j) { j.options.refine_transform = false; },
  };
  int number = 0;
  for (const auto& change : changes) {
    SCOPED_TRACE(number++);
    ReconstructJob other = job_;
    change(other);
    CancelToken token;
    Reporter listener;
    listener.cancel = &token;
    listener.on_note = [&](const std::string& note) {
      if (note.find("begun anew") != std::string::npos) token.cancel();
    };
    EXPECT_THROW(run(other, listener), Interrupted);
  }
}

TEST_F(ReconstructJobTest, WhatSpeaksAgainstAResultIsSaid) {
  job_.options.iterations = 1;
  job_.afm->preparation.noise = AfmNoise{0.5, 0.005};  // a tenth of it
  job_.sem_noise = SemNoise{0, 0.4, 1e-3};
  job_.options.uncertainty = false;
  job_.afm->preparation.tip->doubt = "it is flat";
  const ReconstructSummary s = run(job_);
  EXPECT_EQ(s.verdict, ReconstructionVerdict::flagged);
  EXPECT_EQ(report("result")["verdict"], "flagged");
  EXPECT_THAT(s.reasons, ElementsAre(HasSubstr("had not settled"),
                                     HasSubstr("the AFM scan does not look like noise"),
                                     HasSubstr("the SEM image does not look like noise"),
                                     HasSubstr("the AFM tip is not to be trusted: it is flat")));
  EXPECT_THAT(s.warnings,
              Contains(HasSubstr("it says that this tip is not to be trusted: it is flat")));
  EXPECT_EQ(io::read_tip(path("result") / "tip.txt").doubt, "it is flat");
}

TEST_F(ReconstructJobTest, OneImageIsEnough) {
  ReconstructJob afm = job_;
  afm.sem.reset();
  afm.folder = path("afm");
  EXPECT_THAT(run(afm).result.simulated_sem.data(), IsEmpty());
  EXPECT_FALSE(report("afm").contains("sem"));
  ReconstructJob sem = job_;
  sem.afm.reset();
  sem.folder = path("sem");
  EXPECT_THAT([&] { run(sem); }, ThrowsMessage<UsageError>(HasSubstr("reconstruction.gains")));
  sem.calibration = {{100, 100}, 20};
  run(sem);
  EXPECT_FALSE(report("sem").contains("afm"));
}

TEST_F(ReconstructJobTest, ImagesThatSayNothingAreRefused) {
  ReconstructJob job = job_;
  job.sem->image.values = Grid<double>(50, 40, 7);
  EXPECT_THAT([&] { run(job); },
              ThrowsMessage<InvalidInput>(HasSubstr("all its pixels that count have one value")));
  job = job_;
  job.pose.transform = Affine{1, 0, 9000, 0, 1, 0};
  EXPECT_THAT([&] { run(job); }, ThrowsMessage<InvalidInput>(HasSubstr("lies on the AFM scan")));
  job = job_;
  job.afm->scan.z_nm = Grid<double>(job.afm->scan.z_nm.width(), job.afm->scan.z_nm.height(), 3);
  EXPECT_THAT([&] { run(job); },
              ThrowsMessage<InvalidInput>(HasSubstr("all its heights are the same")));
  job = job_;
  job.afm->preparation.tip = conical_tip(20, 0.4, {pitch, pitch, 201, 201});
  EXPECT_THAT([&] { run(job); }, ThrowsMessage<InvalidInput>(HasSubstr("wider than the scan")));
  job = job_;
  for (double& v : job.sem->image.values.data()) v = -v;
  EXPECT_THAT([&] { run(job); }, ThrowsMessage<InvalidInput>(
                                     HasSubstr("darker where the simulated image is brighter")));
  EXPECT_FALSE(std::filesystem::exists(job_.folder / "report.json"));
}

}  // namespace
}  // namespace surf::workflow
