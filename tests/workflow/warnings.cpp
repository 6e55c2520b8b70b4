// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "small_job.h"
#include "surf/mc/physics/dielectric_draft.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> warnings_of(SimulateJob job) {
  const TemporaryFolder folder;
  job.outputs = {folder.path() / "image.exr"};
  job.scene.budget =
      mc::ElectronsPerPixel{std::min<std::int64_t>(mc::electrons_of(job.scene.budget), 2)};
  return run(job).warnings;
}

void scan_about(SimulateJob& job, double x_nm) {
  job.scene.scan = {};
  job.scene.scan.width = job.scene.scan.height = 4;
  job.scene.scan.region = mc::ScanRequest::Region{x_nm - 2, -2, x_nm + 2, 2};
}

TEST(Warnings, AreAbsentWhereNothingIsOdd) { EXPECT_THAT(warnings_of(small_job()), IsEmpty()); }

TEST(Warnings, TellThatNothingIsSeen) {
  SimulateJob job = small_job();
  job.scene.specimen.substrate.reset();
  scan_about(job, 1000);
  const auto warnings = warnings_of(job);
  EXPECT_THAT(warnings, Contains(HasSubstr("outside the specimen")));
  EXPECT_THAT(warnings, Contains(HasSubstr("no pixel")));
}

TEST(Warnings, TellOfUnlikelySizes) {
  for (const double factor : {1e11, 1e-3}) {
    SimulateJob job = small_job();
    job.scene.specimen.substrate.reset();
    transform(job.scene.specimen.bodies[0].mesh, factor, {0, 0, 0});
    job.scene.scan = {};
    job.scene.scan.width = job.scene.scan.height = 4;
    EXPECT_THAT(warnings_of(job), Contains(HasSubstr("is `specimen.unit` right?"))) << factor;
  }
}

TEST(Warnings, TellOfSpecksThatAreLikelyOfAnotherUnit) {
  const auto speck = Contains(HasSubstr(
      "the specimen is 2.00 nm wide, but electrons of 1000 eV reach about 31.8 nm in Si"));
  const auto cube = [](double factor, bool substrate, bool assumed) {
    SimulateJob job = small_job();
    if (!substrate) job.scene.specimen.substrate.reset();
    job.scene.unit_assumed = assumed;
    transform(job.scene.specimen.bodies[0].mesh, factor, {0, 0, 0});
    job.scene.scan = {};
    job.scene.scan.width = job.scene.scan.height = 4;
    return warnings_of(job);
  };
  EXPECT_THAT(cube(0.05, false, true), speck);
  EXPECT_THAT(cube(0.05, false, true),
              Contains(HasSubstr("With `specimen.unit=um` it would be 2.00 um")));
  EXPECT_THAT(cube(0.05, false, false), IsEmpty());  // its unit was named
  EXPECT_THAT(cube(0.05, true, true), IsEmpty());    // a particle on a substrate
  EXPECT_THAT(cube(0.2, false, true), IsEmpty());
}

TEST(Warnings, TellOfMaterialsThatAreEstimated) {
  SimulateJob job = small_job();
  job.scene.specimen.materials[0].estimates = {{"plasmon_ev", "a rule"}};
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("Si: these numbers are estimates: plasmon_ev")));
}

TEST(Warnings, TellOfSpecimensSoFarAwayThatTheyLoseDigits) {
  for (const double offset_nm : {1e10, 1e12}) {
    SimulateJob job = small_job();
    job.scene.specimen.substrate.reset();
    transform(job.scene.specimen.bodies[0].mesh, 1, {offset_nm, 0, 0});
    scan_about(job, offset_nm);
    const auto far = Contains(HasSubstr("coordinates are 0.0002 nm apart"));
    EXPECT_THAT(warnings_of(job),
                offset_nm > 1e11 ? testing::Matcher<std::vector<std::string>>(far) : IsEmpty())
        << offset_nm;
  }
}

TEST(Warnings, TellOfBodiesUnderTheSubstrate) {
  SimulateJob job = small_job();
  job.scene.specimen.substrate->top_nm = 100;
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("below the substrate's top")));
}

TEST(Warnings, TellOfMeshesInsideOut) {
  SimulateJob job = small_job();
  for (Triangle& t : job.scene.specimen.bodies[0].mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("normals point inward")));
}

TEST(Warnings, TellOfScansBeyondAHeightField) {
  SimulateJob job = small_job();
  job.scene.specimen.substrate.reset();
  job.scene.specimen.bodies.clear();
  job.scene.specimen.height_field =
      mc::HeightFieldBody{"mesa", make_mesa({100, 100, 5}, 20, 40, 10), 0, Edge::mirror};
  scan_about(job, 0);
  EXPECT_THAT(warnings_of(job), IsEmpty());
  job.scene.scan.width = job.scene.scan.height = 18;
  job.scene.scan.region = mc::ScanRequest::Region{-90, -90, 90, 90};
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("beyond the height field")));
}

TEST(Warnings, TellOfStandardErrorsThatMeanNothing) {
  SimulateJob job = small_job();
  job.scene.budget = mc::ElectronsPerPixel{1};
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("one electron per pixel")));
}

TEST(Warnings, TellOfUnfittedMaterials) {
  SimulateJob job = small_job();
  job.scene.specimen.materials[0].loss_join_fitted = false;
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("Si: no measured yields")));
  mc::parse_physics("inelastic=dielectric", job.scene.physics);
  EXPECT_THAT(warnings_of(job), testing::Not(Contains(HasSubstr("Si: no measured yields"))))
      << "nothing is fitted to them";
  mc::Material& si = job.scene.specimen.materials[0];
  si.dielectric = mc::complete(mc::DielectricDraft{}, si);
  EXPECT_THAT(warnings_of(job), Contains(HasSubstr("Si: its energy-loss function is an estimate")));
}

}  // namespace
}  // namespace surf::workflow
