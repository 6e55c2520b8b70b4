// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/step_record.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "described.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/certainty_job.h"
#include "surf/workflow/clean_job.h"
#include "surf/workflow/level_job.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/noise_job.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/tip_job.h"
#include "surf/workflow/train_job.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

TEST(StepRecord, EveryParameterThatIsChangedIsInTheRecord) {
  test::every_change_is_recorded<io::HeightReadOptions>(
      {{"scan.height_unit", "2.5um"}, {"scan.height_pitch", "2nmx3nm"}});
  test::every_change_is_recorded<LevelParameters>();
  test::every_change_is_recorded<CleanParameters>(
      {{"clean.spikes", "5:0.25nm"}, {"clean.median", "3"}, {"clean.closing", "7"}});
  test::every_change_is_recorded<MorphologyParameters>();
  test::every_change_is_recorded<CertaintyParameters>({{"scan.height_noise", "0.1nm"}});
  test::every_change_is_recorded<ScanNoiseParameters>();
  test::every_change_is_recorded<TipParameters>(
      {{"scan.height_noise", "0.5nm,0.5"}, {"tip.sweep", "0.1nm,2nm,30"}});
  test::every_change_is_recorded<CharacterizerParameters>();
  test::every_change_is_recorded<TipShapeParameters>({{"tip.shape", "pyramid:5nm,20deg,3,30deg"}});
}

TEST(StepRecord, EveryParameterOfTrainingIsInTheRecord) {
  test::every_change_is_recorded<LearnOptions>(
      {{"training.kind", "secant"}, {"training.scales", "5,7"}, {"training.hidden", "24,12"}});
}

TEST(StepRecord, EveryParameterOfReconstructionIsInTheRecord) {
  test::every_change_is_recorded<ReconstructionOptions>({{"reconstruction.scales", "16,8,4"}});
  test::every_change_is_recorded<AfmPreparationOptions>({{"scan.height_noise", "0.5nm,0.5"}});
  test::every_change_is_recorded<AfmInput>({{"scan.height_noise", "0.5nm,0.5"},
                                            {"scan.height_unit", "2.5um"},
                                            {"scan.height_pitch", "2nmx3nm"}});
  test::every_change_is_recorded<SemInput>({{"scan.pixel_size", "2nmx3nm"}});
  test::every_change_is_recorded<PoseOptions>({{"registration.transform", "1,0,60,0,1,45"}});
}

TEST(StepRecord, TheCommandOfATrainingSaysWhatDiffers) {
  TrainJob job;
  job.material.name = "Si";
  EXPECT_EQ(training_command(job), "semsurf train --material Si");
  job.inputs = {{"folder/a scan.gwy", {}, "", "folder/image.tif"}};
  job.signal = "InLens";
  job.energy_ev = 2500;
  job.physics.cutoff_ev = 5;
  job.learn.hidden.emplace();
  job.learn.model_error = 0.013;
  job.learn.multi_resolution = true;
  job.simulation.threads = 7;  // does not change the model
  job.simulation.budget = mc::Accuracy{0.02};
  EXPECT_EQ(training_command(job),
            "semsurf train 'a scan.gwy' --signal image.tif:InLens --material Si --hidden 0 "
            "--model-error 1.3% "
            "--multi-resolution --energy 2.5keV --accuracy 2% --cutoff 5eV");
  TrainJob quadrants;
  quadrants.detectors = mc::parse_detectors("quadrants", "test");
  const std::string command = training_command(quadrants);
  const auto from = command.find("--detector '"), to = command.find('\'', from + 12);
  ASSERT_NE(from, std::string::npos) << command;
  TrainJob again;
  set_parameter(again, "simulation.detectors", command.substr(from + 12, to - from - 12));
  EXPECT_EQ(training_command(again), command);
  for (const auto& [name, text] :
       std::map<std::string, std::string>{{"training.surfaces", "12"},
                                          {"training.edge", "flat"},
                                          {"training.pixel_size", "3"},
                                          {"simulation.seed", "9"},
                                          {"scan.height_pitch", "2nmx3nm"}}) {
    TrainJob changed;
    set_parameter(changed, name, text);
    EXPECT_NE(record_of(changed), record_of(TrainJob())) << name;
  }
}

TEST(StepRecord, NamesStepOptionsAndInputs) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "scan.txt";
  std::ofstream(file) << "1 2\n3 4\n";
  io::HeightReadOptions reading;
  reading.z_unit_nm = 1000;
  const auto made = step_record("level", records_of(LevelParameters{}, reading), {file});
  EXPECT_EQ(made.at("semsurf.version"), version());
  EXPECT_EQ(made.at("command"), "level");
  EXPECT_EQ(made.at("option.level.method"), "hough");
  EXPECT_EQ(made.at("option.scan.height_unit_nm"), "1000");
  EXPECT_THAT(made.at("input.1"), testing::MatchesRegex("scan.txt sha256 [0-9a-f]{64}"));
}

}  // namespace
}  // namespace surf::workflow
