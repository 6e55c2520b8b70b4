// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/clean_job.h"

#include <gmock/gmock.h>

#include "heard.h"
#include "surf/afm/noise.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

HeightField scan() {
  HeightField f{{2, 2}, Grid<double>(30, 20)};
  f.z_nm = simulate_noise({0, 0.01}, 30, 20, 1);
  f.z_nm(10, 10) = 50;
  return f;
}

TEST(CleanJob, DoesWhatIsAskedFor) {
  CleanParameters p;
  p.spikes = Spikes{3, 5.0};
  const CleanResult r = clean(scan(), p);
  ASSERT_TRUE(r.spikes);
  EXPECT_EQ(r.spikes->changed, 1u);
  EXPECT_FALSE(r.median || r.closing);
  EXPECT_LT(r.field.z_nm(10, 10), 1);
  EXPECT_EQ(r.field.z_nm(0, 0), scan().z_nm(0, 0));
}

TEST(CleanJob, FindsTheLimitOfSpikes) {
  CleanParameters p;
  set_parameter(p, "clean.spikes", "3");
  const CleanResult r = clean(scan(), p);
  EXPECT_EQ(r.spikes->changed, 1u);
  EXPECT_NEAR(r.used.spikes->limit_nm.value_or(0), 0.6, 0.1);
  EXPECT_THAT(record_of(r.used).at("clean.spikes"), testing::StartsWith("3:0."));
  HeightField flat = scan();
  std::ranges::fill(flat.z_nm.data(), 1.0);
  test::Heard heard;
  EXPECT_FALSE(
      clean(flat, p, heard.reporter()).spikes);  // without noise nothing is a spike for sure
  EXPECT_THAT(heard.notes, testing::ElementsAre(testing::HasSubstr("`clean.spikes`")));
}

TEST(CleanJob, RefusesEvenWidths) {
  CleanParameters p;
  p.median = 4;
  EXPECT_THROW(clean(scan(), p), UsageError);
  p = {};
  EXPECT_THROW(set_parameter(p, "clean.spikes", "3:0nm"), UsageError);
  EXPECT_THROW(set_parameter(p, "clean.spikes", "2003"), UsageError);
}

}  // namespace
}  // namespace surf::workflow
