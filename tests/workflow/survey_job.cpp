// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/survey_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "off.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;

constexpr double pitch_nm = 2, noise_nm = 0.1, radius_nm = 15, pillar_nm = 40;

/// Pillars 40 nm high: two needles, which show the tip, and two blocks.
HeightField pillars() {
  HeightField field{{pitch_nm, pitch_nm, 0, 0}, Grid<double>(128, 96)};
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x)
      for (const auto& [cx, cy, half] : {std::array{25, 30, 0}, std::array{70, 50, 9},
                                         std::array{105, 25, 0}, std::array{40, 75, 7}})
        if (std::abs(x - cx) <= half && std::abs(y - cy) <= half) field.z_nm(x, y) = pillar_nm;
  return field;
}

HeightField scan_of(const HeightField& surface, double noise) {
  TipShapeParameters tip;
  tip.shape.radius_nm = radius_nm;
  tip.size = 41;
  tip.pitch_x_nm = tip.pitch_y_nm = pitch_nm;
  HeightField scan = dilate(surface, tip_by_shape(tip));
  const Grid<double> drawn = simulate_noise({0, noise * noise}, 128, 96, 3);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    scan.z_nm.data()[i] += drawn.data()[i] + 0.01 * double(i % 128);
  return scan;
}

TEST(Survey, FindsNoiseTipAndBroadening) {
  SurveyParameters parameters;
  parameters.draws = 3;
  TipParameters tip;
  tip.size = 41;
  const SurveyedScan s = survey_scan(scan_of(pillars(), noise_nm), parameters, {}, tip);
  EXPECT_EQ(s.width, 128);
  EXPECT_NEAR(s.tilt_deg, std::atan(0.01 / pitch_nm) * 180 / M_PI, 0.02);
  EXPECT_NEAR(*s.noise_nm, noise_nm, 0.02);
  EXPECT_NEAR(s.roughness_nm, noise_nm, 0.03);
  EXPECT_NEAR(s.relief_nm, pillar_nm, 1);
  ASSERT_TRUE(s.tip_radius_nm && s.tip_radius_error_nm && s.broadening_nm) << s.problem;
  EXPECT_NEAR(*s.tip_radius_nm, radius_nm, 4);
  EXPECT_GT(*s.tip_radius_error_nm, 0);
  EXPECT_LT(*s.tip_radius_error_nm, 4);
  // Half way up a cone of 15 nm and 15 degrees is wider by 17 nm than its apex is.
  const double truly_nm = 17;
  EXPECT_NEAR(*s.broadening_nm, truly_nm, 4);
}

TEST(Survey, AFlatScanHasNoTipAndSaysSo) {
  const SurveyedScan s =
      survey_scan(scan_of({{pitch_nm, pitch_nm, 0, 0}, Grid<double>(128, 96)}, noise_nm), {});
  EXPECT_NEAR(*s.noise_nm, noise_nm, 0.02);
  EXPECT_FALSE(s.problem.empty());
}

// A calibration grating's plateaus have no sharp end.
TEST(Survey, ARadiusThatNoiseMovesByMoreIsAProblem) {
  const auto path = test::test_data("afm/CL_0deg_xcal.spm");
  if (!path) GTEST_SKIP() << "SEMSURF_TEST_DATA has no such scan: real files are not tested";
  const HeightField scan = io::read_height_field(*path).field;
  const SurveyedScan s = survey_scan(scan, {.draws = 4});
  ASSERT_TRUE(s.tip_radius_nm && s.tip_radius_error_nm);
  ASSERT_GT(*s.tip_radius_error_nm, *s.tip_radius_nm);
  EXPECT_THAT(s.problem, testing::HasSubstr("radius is not known"));
}

TEST(Survey, WithoutTheTipNothingIsSaidOfIt) {
  SurveyParameters parameters;
  parameters.no_tip = true;
  const SurveyedScan s = survey_scan(scan_of(pillars(), noise_nm), parameters);
  EXPECT_FALSE(s.tip_radius_nm || s.broadening_nm);
  EXPECT_TRUE(s.problem.empty()) << s.problem;
}

TEST(Survey, TablesHaveALinePerScanAndQuoteWhatMustBe) {
  SurveyedScan a, b;
  a.file = "a.spm", b.file = "with, comma \"and\" quotes";
  b.tip_radius_nm = 12.5;
  const std::string csv = survey_csv(std::vector{a, b});
  EXPECT_EQ(std::ranges::count(csv, '\n'), 3);
  EXPECT_THAT(csv, HasSubstr("\na.spm,0,0,"));
  EXPECT_THAT(csv, HasSubstr("\n\"with, comma \"\"and\"\" quotes\",0,"));
  EXPECT_THAT(csv, HasSubstr(",12.5,,,,\n"));
}

TEST(Survey, FoldersAreTheirScansByName) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(scans_of({folder.path()}), FileError);
  for (const char* name : {"b.gsf", "a.gsf"})
    io::write_height_field(folder.path() / name, pillars());
  io::write_text(folder.path() / "notes.md", "no scan");
  io::write_text(folder.path() / "notes.txt", "no scan either");
  EXPECT_THAT(scans_of({folder.path(), "else.spm"}),
              testing::ElementsAre(folder.path() / "a.gsf", folder.path() / "b.gsf", "else.spm"));
}

TEST(Survey, CanBeInterrupted) {
  CancelToken token;
  token.cancel();
  Reporter listener;
  listener.cancel = &token;
  EXPECT_THROW(survey_scan(scan_of(pillars(), noise_nm), {}, {}, {}, listener), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
