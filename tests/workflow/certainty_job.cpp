// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/certainty_job.h"

#include <gmock/gmock.h>

#include "heard.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

HeightField scan() {
  HeightField f{{2, 2}, Grid<double>(40, 30)};
  f.z_nm = simulate_noise({0, 1}, 40, 30, 1);
  return f;
}

TEST(CertaintyJob, FindsTheNoiseAndSaysSo) {
  test::Heard heard;
  const CertaintyResult r =
      certainty(scan(), conical_tip(5, 0.5, {2, 2, 5, 5}), {}, heard.reporter());
  EXPECT_DOUBLE_EQ(r.used.noise_nm.value_or(0), pixel_noise_nm(scan()));
  EXPECT_EQ(r.used.neighbourhood, r.map.neighbourhood);
  EXPECT_TRUE(r.trustworthy);
  EXPECT_THAT(heard.notes,
              testing::ElementsAre(testing::HasSubstr("`scan.height_noise` says otherwise")));
}

TEST(CertaintyJob, WarnsOfATipThatCannotHaveMadeTheScan) {
  Tip flat = conical_tip(5, 0.5, {2, 2, 5, 5});
  std::ranges::fill(flat.z_nm.data(), 0.0);
  CertaintyParameters p;
  p.noise_nm = 0.001;
  test::Heard heard;
  EXPECT_FALSE(certainty(scan(), flat, p, heard.reporter()).trustworthy);
  EXPECT_THAT(heard.warnings, testing::ElementsAre(testing::HasSubstr(
                                  "or `scan.height_noise` larger. A map of so little")));
}

TEST(CertaintyJob, TakesNoCorrelation) {
  CertaintyParameters p;
  EXPECT_THROW(set_parameter(p, "scan.height_noise", "0.1nm,0.5"), UsageError);
  EXPECT_THROW(set_parameter(p, "scan.height_noise", "-1nm"), UsageError);
}

}  // namespace
}  // namespace surf::workflow
