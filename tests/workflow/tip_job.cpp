// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/tip_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "heard.h"
#include "surf/afm/morphology.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Two narrow walls that cross, seen by a cone.
HeightField walls() {
  HeightField f{{5, 5}, Grid<double>(60, 50)};
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x)
      f.z_nm(x, y) = std::abs(x - 20) < 2 || std::abs(y - 30) < 2 ? 40 : 0;
  f = dilate(f, conical_tip(30, 0.35, {5, 5, 25, 25}));
  const Grid<double> noise = simulate_noise({0, 0.04}, 60, 50, 4);
  for (std::size_t i = 0; i < noise.size(); ++i) f.z_nm.data()[i] += noise.data()[i];
  return f;
}

TipParameters small() {
  TipParameters p;
  p.size = 7;
  p.noise = AfmNoise{0, 0.04};
  return p;
}

TEST(TipJob, SweepsAndSaysWhatItUsed) {
  TipParameters p = small();
  p.noise.reset();
  p.sweep_least_nm = 0.1, p.sweep_most_nm = 2, p.sweep_thresholds = 8;
  test::Heard heard;
  const TipResult r = find_tip({walls()}, p, heard.reporter());
  EXPECT_EQ(r.used.answer, TipAnswer::sweep);
  EXPECT_TRUE(r.noise_found);
  EXPECT_NEAR(r.sigma_nm, 0.2, 0.1);
  ASSERT_TRUE(r.sweep);
  EXPECT_EQ(r.sweep->curve.size(), 8u);
  EXPECT_EQ(r.used.threshold_nm, r.sweep->curve[r.sweep->chosen].threshold_nm);
  const Record record = record_of(r.used);
  EXPECT_EQ(record.at("tip.answer"), "sweep");
  EXPECT_EQ(record.at("tip.sweep_nm"), "0.1,2,8");
  EXPECT_TRUE(record.contains("scan.height_noise_nm"));
  EXPECT_GT(heard.furthest, 0.9);
}

TEST(TipJob, GivesTheOtherAnswers) {
  TipParameters p = small();
  p.answer = TipAnswer::outer;
  const TipResult outer = find_tip({walls()}, p);
  EXPECT_GT(outer.used.threshold_nm.value_or(0), 0.4);
  EXPECT_EQ(outer.used.apex_tolerance_nm, outer.used.threshold_nm);
  p.answer = TipAnswer::best;
  EXPECT_TRUE(find_tip({walls()}, p).best);
  p.answer.reset();
  p.threshold_nm = 0.5;
  const TipResult blind = find_tip({walls()}, p);
  EXPECT_EQ(blind.used.answer, TipAnswer::blind);
  EXPECT_TRUE(blind.blind);
}

TEST(TipJob, DoubtsATipThatTheScanDoesNotTell) {
  TipParameters p = small();
  p.noise = AfmNoise{0, 400};
  p.sweep_least_nm = 1, p.sweep_most_nm = 160, p.sweep_thresholds = 6;
  test::Heard heard;
  EXPECT_NE(find_tip({walls()}, p, heard.reporter()).tip.doubt, "");
  EXPECT_THAT(heard.warnings,
              Contains(HasSubstr("is `scan.height_noise` right, is `tip.size` large enough?")));
}

TEST(TipJob, RefusesWhatDoesNotFit) {
  const auto refused = [](auto change) {
    TipParameters p = small();
    change(p);
    EXPECT_THROW(find_tip({walls()}, p), UsageError);
  };
  refused([](TipParameters& p) { p.size = 8; });
  refused([](TipParameters& p) { p.answer = TipAnswer::blind; });
  refused([](TipParameters& p) { p.answer = TipAnswer::outer, p.threshold_nm = 1; });
  refused([](TipParameters& p) { p.answer = TipAnswer::best, p.sweep_thresholds = 10; });
  refused([](TipParameters& p) { p.answer = TipAnswer::sweep, p.layer_nm = 1; });
  TipParameters p;
  EXPECT_THROW(set_parameter(p, "scan.height_noise", "0nm"), UsageError);
  EXPECT_THROW(set_parameter(p, "scan.height_noise", "1nm,1"), UsageError);
  set_parameter(p, "scan.height_noise", "2nm,-0.5");
  EXPECT_EQ(p.noise->alpha, -0.5);
  EXPECT_NEAR(std::sqrt(p.noise->variance_nm2()), 2, 1e-12);
}

TEST(TipJob, ByACharacterizer) {
  HeightField known = walls();
  CharacterizerParameters p;
  p.size = 5;
  p.search = 2;
  const CharacterizedTip found = tip_by_characterizer(known, known, p);
  EXPECT_EQ(found.tip.z_nm.width(), 5);
  p.size = 4;
  EXPECT_THROW(tip_by_characterizer(known, known, p), UsageError);
}

TEST(TipJob, ByShape) {
  for (const char* text : {"cone:5nm,20deg", "parabola:5nm", "pyramid:5nm,20deg,3",
                           "pyramid:5nm,20deg,3,30deg", "ball:5nm", "ball:5nm,2nm,5deg"}) {
    TipShapeParameters p;
    p.shape = parse_tip_shape(text, "shape");
    EXPECT_EQ(format_tip_shape(p.shape), text);
    p.size = 9;
    EXPECT_EQ(tip_by_shape(p).z_nm.width(), 9) << text;
  }
  for (const char* text : {"", "cone", "cone:5nm", "cone:5nm,20deg,3", "ball:5nm,2nm",
                           "ball:5nm,0nm,5deg", "pyramid:5nm,20deg,2", "spoon:1nm"})
    EXPECT_THROW(parse_tip_shape(text, "shape"), UsageError) << text;
  TipShapeParameters steep;
  steep.shape.half_angle_deg = 95;
  EXPECT_THROW(tip_by_shape(steep), UsageError);
}

}  // namespace
}  // namespace surf::workflow
