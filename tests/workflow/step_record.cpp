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
#include "surf/workflow/tip_job.h"
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
  test::every_change_is_recorded<TipParameters>({{"scan.height_noise", "0.5nm,0.5"}, {"tip.sweep", "0.1nm,2nm,30"}});
  test::every_change_is_recorded<CharacterizerParameters>();
  test::every_change_is_recorded<TipShapeParameters>({{"tip.shape", "pyramid:5nm,20deg,3,30deg"}});
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
