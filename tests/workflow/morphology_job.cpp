// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/morphology_job.h"

#include <gmock/gmock.h>

#include "heard.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

HeightField scan() {
  HeightField f{{2, 2}, Grid<double>(30, 20)};
  f.z_nm = simulate_noise({0, 1}, 30, 20, 1);
  return f;
}

const Tip tip = conical_tip(5, 0.5, {2, 2, 9, 9});

TEST(MorphologyJob, IsTheLibrarys) {
  const HeightField f = scan();
  EXPECT_EQ(morphology(MorphologyOperation::erode, f, tip, {}).z_nm, erode(f, tip).z_nm);
  EXPECT_EQ(morphology(MorphologyOperation::dilate, f, tip, {}).z_nm, dilate(f, tip).z_nm);
  EXPECT_EQ(morphology(MorphologyOperation::open, f, tip, {}).z_nm, opening(f, tip).z_nm);
  EXPECT_EQ(morphology(MorphologyOperation::close, f, tip, {}).z_nm, closing(f, tip).z_nm);
  MorphologyParameters away;
  away.distance_nm = 3;
  EXPECT_EQ(morphology(MorphologyOperation::dilate, f, tip, away).z_nm,
            dilate_noncontact(f, tip, 3).z_nm);
  EXPECT_THROW(morphology(MorphologyOperation::open, f, tip, away), UsageError);
  away.upsample = 33;
  EXPECT_THROW(morphology(MorphologyOperation::erode, f, tip, away), UsageError);
}

TEST(MorphologyJob, TipsAreMadeToMeetTheScan) {
  test::Heard heard;
  Tip coarse = conical_tip(5, 0.5, {4, 4, 5, 5});
  coarse.doubt = "it is flat";
  const Tip met = tip_for(coarse, scan(), "cone.gsf", heard.reporter());
  EXPECT_EQ(met.pitch_x_nm, 2);
  EXPECT_EQ(met.z_nm.width(), 9);
  EXPECT_THAT(heard.notes,
              testing::ElementsAre(testing::HasSubstr("cone.gsf: resampled from 5 x 5")));
  EXPECT_THAT(heard.warnings,
              testing::ElementsAre(testing::HasSubstr("not to be trusted: it is flat")));
  heard = {};
  tip_for(conical_tip(5, 0.5, {2, 2, 41, 9}), scan(), "wide.gsf", heard.reporter());
  EXPECT_THAT(heard.warnings, testing::ElementsAre(testing::HasSubstr("more than the scan has")));
}

}  // namespace
}  // namespace surf::workflow
