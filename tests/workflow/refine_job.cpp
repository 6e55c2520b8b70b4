// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/refine_job.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/profile/feature_shape.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double energy_ev = 300, pixel_nm = 2, tilt_deg = 15, height_nm = 30;
constexpr int columns = 48, rows = 8;

TriangleMesh line(double width_nm, double angle_deg) {
  return feature_mesh({FeatureKind::line, width_nm, 0, {height_nm, angle_deg, 1, 1}}, 300);
}

/// A line of silicon whose walls lean out, from both sides.
class RefineJobTest : public testing::Test {
 protected:
  static PlacedImage view(double azimuth_deg) {
    mc::Specimen specimen;
    specimen.materials = {io::find_material("Si", "test")};
    specimen.bodies.push_back({"line", line(40, 97), 0});
    mc::Beam beam;
    beam.energy_ev = energy_ev;
    beam.tilt_deg = tilt_deg, beam.azimuth_deg = azimuth_deg;
    mc::Scan scan;
    scan.width = columns, scan.height = rows;
    scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
    mc::SimulationOptions options;
    options.budget = mc::ElectronsPerPixel{150};
    options.seed = 9;
    const mc::SimulationResult done = mc::simulate(mc::Scene(specimen, beam, scan), options, {});
    PlacedImage image;
    image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
    image.origin_x_nm = -0.5 * (columns - 1) * pixel_nm;
    image.origin_y_nm = -0.5 * (rows - 1) * pixel_nm;
    image.values = Grid<double>(columns, rows);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) image.values(x, y) = 40 + 500 * done.yield(0, x, y).mean;
    return image;
  }

  RefineJobTest() {
    static const PlacedImage left = view(0), right = view(180);
    job_.start = line(42, 90);
    job_.start_file = file("start.stl");
    job_.images = {{left, file("left.tif"), {}}, {right, file("right.tif"), {}}};
    job_.tilts_deg = {tilt_deg};
    job_.azimuths_deg = {0, 180};
    job_.material = io::find_material("Si", "test");
    job_.energy_ev = energy_ev;
    job_.edge_nm = 5;
    job_.start_error_nm = 5;
    job_.height_error_nm = 1;
    job_.electrons = 400, job_.effect_electrons = 20;
    job_.smooth_rounds = 2, job_.bump_rounds = 0;
    job_.picture = false;
    static const test::TemporaryFolder cascades;
    job_.cache = cascades.path();
    job_.folder = folder_.path() / "result";
  }

  std::filesystem::path file(const char* name) {
    io::write_text(folder_.path() / name, "made");
    return folder_.path() / name;
  }

  test::TemporaryFolder folder_;
  RefineJob job_;
};

/// How far the walls lean out over their feet, mean of both.
double lean(const TriangleMesh& mesh) {
  std::array<double, 2> x{}, n{};
  for (const Vec3& p : mesh.vertices_nm) {
    if (std::abs(p.y) > 6 || std::abs(p.x) > 60 || p.z < 3 || p.z > height_nm - 3) continue;
    const std::size_t half = p.z > 0.5 * height_nm ? 1 : 0;
    x[half] += std::abs(p.x), ++n[half];
  }
  // Middles of halves of what is looked at.
  return (x[1] / n[1] - x[0] / n[0]) * height_nm / (0.5 * (height_nm - 6));
}

TEST_F(RefineJobTest, FindsWallsThatLean) {
  const RefineSummary s = run(job_);
  const double truth = height_nm * std::tan(7 * degrees_to_radians);
  EXPECT_NEAR(lean(s.before), 0, 0.3);
  EXPECT_NEAR(lean(s.mesh), truth, 1.2);
  EXPECT_EQ(s.self_intersections, 0u);
  for (const RefinedImage& image : s.images) EXPECT_LT(image.unexplained, image.unexplained_before);
  for (const char* file :
       {"surface.vtp", "surface.stl", "section.csv", "view1.vti", "view2.vti", "report.json"})
    EXPECT_TRUE(std::filesystem::exists(job_.folder / file)) << file;
}

// The rim of a sheet folds back at the line's ends, seen from above. What is wrong here is that the
// images show another line.
TEST_F(RefineJobTest, AnUndercutLineMayBeTheStart) {
  job_.start = feature_mesh({FeatureKind::line, 92, 0, {100, 100, 4, 3}}, 700);
  job_.folder.clear();
  job_.electrons = 20;
  EXPECT_THAT([&] { run(job_); },
              ThrowsMessage<InvalidInput>(HasSubstr("does not show this specimen")));
}

TEST_F(RefineJobTest, RefusesImagesOfSomethingElse) {
  job_.folder.clear();
  for (double& v : job_.images[1].image.values.data()) v = 0;
  for (int y = 0; y < rows; ++y) job_.images[1].image.values(y, y) = 100;
  EXPECT_THAT([&] { run(job_); },
              ThrowsMessage<InvalidInput>(HasSubstr("does not show this specimen")));
}

TEST_F(RefineJobTest, RefusesBadInput) {
  const auto refused = [](const RefineJob& job, const char* words) {
    EXPECT_THAT([&] { run(job); }, ThrowsMessage<UsageError>(HasSubstr(words)));
  };
  RefineJob job = job_;
  job.azimuths_deg = {0, 90, 180};
  refused(job, "3 values are given for 2 images");
  job = job_, job.tilts_deg = {75};
  refused(job, "out of range");
  job = job_, job.images.clear();
  refused(job, "no image is given");
  job = job_, job.signals = {"XX"};
  refused(job, "XX");
  job = job_, job.material = {};
  refused(job, "it is missing");
}

}  // namespace
}  // namespace surf::workflow
