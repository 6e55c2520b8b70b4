// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/count_job.h"

#include "small_job.h"
#include "statistics.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

CountJob on_the_cube(double x_nm, double y_nm) {
  CountJob job;
  job.scene = small_job().scene;
  job.at_nm = {x_nm, y_nm};
  job.electrons = {1, 7};
  job.trials = 400;
  job.threads = 1;
  return job;
}

TEST(CountJob, CountsEveryTrialOnce) {
  const CountSummary s = run(on_the_cube(0, 0));
  ASSERT_EQ(s.sets.size(), 4u);
  EXPECT_EQ(s.sets[0].detector, "SE");
  EXPECT_EQ(s.sets[1].detector, "BSE");
  EXPECT_EQ(s.sets[3].electrons, 7);
  for (const DetectorCounts& set : s.sets) {
    EXPECT_EQ(moments(set.counts).trials, 400);
    EXPECT_GT(set.counts.back(), 0);
  }
  EXPECT_NEAR(s.hit_nm.z, 40, 1e-6);
  EXPECT_NEAR(s.hit_nm.x, 0, 1e-6);
}

// Seven primaries are a sum of seven independent ones, and the mean is that of a pixel of the image
// there.
TEST(CountJob, HasTheStatisticsOfTheImage) {
  CountJob job = on_the_cube(2.5, 0);
  job.trials = 3000;
  const CountSummary s = run(job);
  mc::Scan scan;
  scan.width = scan.height = 1;
  scan.pixel_x_nm = scan.pixel_y_nm = 1e-6;
  scan.center_x_nm = 2.5;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{20000};
  options.seed = 99;
  options.threads = 1;
  const mc::Scene scene(job.scene.specimen, job.scene.beam, scan, job.scene.physics);
  const mc::SimulationResult pixel = mc::simulate(scene, options);
  for (std::size_t d = 0; d < 2; ++d) {
    const mc::Estimate truth = pixel.yield(d, 0, 0);
    const CountMoments one = moments(s.sets[d].counts), seven = moments(s.sets[2 + d].counts);
    test::expect_mean(one.mean, std::hypot(std::sqrt(one.variance / 3000), truth.standard_error),
                      truth.mean, 8);
    test::expect_mean(seven.mean / 7,
                      std::hypot(std::sqrt(seven.variance / 3000) / 7, truth.standard_error),
                      truth.mean, 8);
    // The variances too: of a variance about sqrt((2 + excess kurtosis) / n), with kurtosis below
    // 10 for one.
    test::expect_mean(one.variance, one.variance * std::sqrt(12.0 / 3000),
                      20000 * truth.standard_error * truth.standard_error, 8);
    test::expect_mean(seven.variance / 7, one.variance * std::sqrt(12.0 / 3000 + 4.0 / 3000),
                      one.variance, 8);
  }
}

TEST(CountJob, ThreadsDoNotChangeTheResult) {
  CountJob job = on_the_cube(0, 0);
  const CountSummary one = run(job);
  job.threads = 3;
  const CountSummary three = run(job);
  for (std::size_t i = 0; i < one.sets.size(); ++i)
    EXPECT_EQ(one.sets[i].counts, three.sets[i].counts);
  job.seed = 2;
  EXPECT_NE(run(job).sets[2].counts, one.sets[2].counts);
}

TEST(CountJob, TiltedBeamsAimAtThePointOfTheImage) {
  CountJob job = on_the_cube(3, 4);
  job.scene.beam.tilt_deg = 30;
  job.scene.beam.azimuth_deg = 90;  // towards +y
  job.trials = 100;
  job.electrons = {1};
  for (const double working_distance : {0.0, 5e6}) {
    job.scene.beam.working_distance_nm = working_distance;
    const Vec3 hit = run(job).hit_nm;
    // The same from an image of one pixel there.
    const mc::Scan scan =
        resolve_scan(job.scene.scan, mc::extent(job.scene.specimen), job.scene.beam);
    const mc::Scene scene(job.scene.specimen, job.scene.beam, scan, job.scene.physics);
    const Vec3 d = mc::direction(job.scene.beam);
    Vec3 seen;
    // Scan plane: x stays x, up is y turned by the tilt.
    const Vec3 point = Vec3{scan.center_x_nm, scan.center_y_nm, scan.center_z_nm} +
                       Vec3{1, 0, 0} * (3 - scan.center_x_nm) +
                       Vec3{0, -d.z, d.y} * (4 - scan.center_y_nm);
    ASSERT_TRUE(scene.first_surface(point - d * 1e5, d, seen));
    EXPECT_LT(length(hit - seen), 1e-3) << working_distance;
  }
}

TEST(CountJob, RefusesWhatItCannotDo) {
  CountJob job = on_the_cube(0, 0);
  job.trials = 3;
  EXPECT_THROW(run(job), UsageError);
  job = on_the_cube(0, 0);
  job.electrons = {1, 0};
  EXPECT_THROW(run(job), UsageError);
  job.electrons = {};
  EXPECT_THROW(run(job), UsageError);
  job = on_the_cube(500, 0);
  job.scene.specimen.substrate.reset();
  EXPECT_THROW(run(job), InvalidInput);
}

TEST(CountJob, CanBeEnded) {
  CountJob job = on_the_cube(0, 0);
  CancelToken token;
  token.cancel();
  EXPECT_THROW(run(job, {.cancel = &token}), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
