// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/simplify_specimen.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/core/large_grid.h"
#include "surf/io/image_file.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/mesh_deviation.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

mc::Scan scan(int pixels, double pixel_nm) {
  mc::Scan s;
  s.width = s.height = pixels;
  s.pixel_x_nm = s.pixel_y_nm = pixel_nm;
  return s;
}

mc::Specimen silicon() {
  mc::Specimen s;
  s.materials = {io::find_material("Si", "test")};
  s.materials[0].loss_join_fitted = true;
  return s;
}

mc::Specimen rough(Edge edge = Edge::mirror) {
  mc::Specimen s = silicon();
  s.height_field = mc::HeightFieldBody{"rough", make_rough({60, 60, 0.5}, 2, 8, 7), 0, edge};
  return s;
}

mc::Specimen ball_on_silicon() {
  mc::Specimen s = silicon();
  s.substrate = mc::Substrate{0, 0.0};
  s.bodies = {{"ball", make_sphere({0, 0, 15}, 20, 5), 0}};
  return s;
}

mc::Specimen simplified(const mc::Specimen& s, double tolerance_nm, Simplification& done) {
  return simplify_specimen(s, tolerance_nm, {}, scan(8, 4), {}, 1, done);
}

// The surface that the beam meets first, straight from above.
double height(const mc::Scene& scene, double x, double y) {
  Vec3 hit;
  EXPECT_TRUE(scene.first_surface({x, y, 1e4}, {0, 0, -1}, hit));
  return hit.z;
}

TEST(SimplifySpecimen, KeepsMeshesWithinTheTolerance) {
  const mc::Specimen original = ball_on_silicon();
  Simplification done;
  const mc::Specimen simple = simplified(original, 0.2, done);
  ASSERT_EQ(done.bodies.size(), 1u);
  EXPECT_EQ(done.bodies[0].kept, "");
  EXPECT_EQ(done.bodies[0].triangles_before, original.bodies[0].mesh.triangles.size());
  EXPECT_EQ(done.bodies[0].triangles_after, simple.bodies[0].mesh.triangles.size());
  EXPECT_LT(done.bodies[0].triangles_after, done.bodies[0].triangles_before / 4);
  const double dense =
      mesh_deviation(original.bodies[0].mesh, simple.bodies[0].mesh, {.spacing_nm = 0.2})
          .largest_nm();
  EXPECT_LE(dense, 1.1 * 0.2);
  EXPECT_GT(dense, 0.05) << "the tolerance is made use of";
  EXPECT_TRUE(check_mesh(simple.bodies[0].mesh).closed_and_oriented);
  EXPECT_THAT(describe(done.bodies[0]), HasSubstr("ball: 20480 triangles to "));
  EXPECT_THAT(warnings_of(original, done), IsEmpty());
}

TEST(SimplifySpecimen, KeepsHeightFieldsWithinTheToleranceAlsoInTheirContinuation) {
  for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
    const mc::Specimen original = rough(edge);
    Simplification done;
    const mc::Specimen simple = simplified(original, 0.3, done);
    ASSERT_FALSE(simple.height_field);
    ASSERT_EQ(simple.bodies.size(), 1u);
    EXPECT_LT(done.bodies[0].triangles_after, done.bodies[0].triangles_before / 4);
    EXPECT_LE(done.bodies[0].deviation_nm, 0.3);
    const mc::SceneOptions bare{.distance_grid_bytes = 0};
    const mc::Scene a(original, {}, scan(8, 4), {}, bare), b(simple, {}, scan(8, 4), {}, bare);
    double worst = 0;
    for (double x = -50; x <= 50; x += 1.37)  // the field ends at 30
      for (double y = -50; y <= 50; y += 1.73)
        worst = std::max(worst, std::abs(height(a, x, y) - height(b, x, y)));
    EXPECT_LE(worst, 0.3 + 1e-5);
    EXPECT_GT(worst, 0.2);
  }
}

TEST(SimplifySpecimen, KeepsWhatTouchesTouching) {
  mc::Specimen original = silicon();
  original.substrate = mc::Substrate{0, 0.0};
  // A drum of many facets on the substrate, and one on top of it.
  original.bodies = {{"lower", make_cone({0, 0, 0}, 20, 20, 10, 200), 0},
                     {"upper", make_cone({0, 0, 10}, 20, 10, 10, 200), 0}};
  Simplification done;
  const mc::Specimen simple = simplified(original, 0.5, done);
  const auto at = [](const TriangleMesh& mesh, double z) {
    return std::ranges::count_if(mesh.vertices_nm, [z](const Vec3& v) { return v.z == z; });
  };
  EXPECT_EQ(at(simple.bodies[0].mesh, 0), at(original.bodies[0].mesh, 0));
  EXPECT_EQ(at(simple.bodies[0].mesh, 10), at(original.bodies[0].mesh, 10));
  EXPECT_EQ(at(simple.bodies[1].mesh, 10), at(original.bodies[1].mesh, 10));
  EXPECT_LT(at(simple.bodies[1].mesh, 20), at(original.bodies[1].mesh, 20) / 2);
  EXPECT_EQ(done.bodies[0].kept, "nothing would be gained");
  EXPECT_THAT(warnings_of(original, done),
              ElementsAre("lower: with `simulation.mesh_tolerance=0.500 nm` nothing would be "
                          "gained; it stays as it is"));
}

TEST(SimplifySpecimen, LeavesAHeightFieldThatBodiesStandOn) {
  mc::Specimen original = silicon();
  HeightField field = make_rough({60, 60, 0.5}, 2, 8, 7);
  for (int y = 40; y < 80; ++y)
    for (int x = 40; x < 80; ++x) field.z_nm(x, y) = 3;
  original.height_field = mc::HeightFieldBody{"", field, 0, Edge::flat};
  original.bodies = {{"box", make_box({-3, -3, 3}, {3, 3, 9}), 0}};
  Simplification done;
  EXPECT_TRUE(simplified(original, 0.3, done).height_field);
  EXPECT_EQ(done.bodies[0].kept, "bodies stand on it");
  original.bodies[0].mesh = make_box({-3, -3, 1}, {3, 3, 9});  // sunk in: no faces meet
  EXPECT_FALSE(simplified(original, 0.3, done).height_field);
}

TEST(SimplifySpecimen, LeavesAMeshThatWouldPassThroughItself) {
  // Two shells 0.2 nm apart, wavy: one surface cannot stay clear of the other within 2 nm.
  mc::Specimen original = silicon();
  TriangleMesh mesh = make_sphere({0, 0, 0}, 20, 4);
  for (Vec3& v : mesh.vertices_nm)
    v = v * (1 + 0.1 * std::sin(v.x) * std::sin(v.y) * std::sin(v.z));
  TriangleMesh inner = mesh;
  transform(inner, 0.99, {});
  const auto base = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), inner.vertices_nm.begin(),
                          inner.vertices_nm.end());
  for (const Triangle& t : inner.triangles)
    mesh.triangles.push_back({base + t[0], base + t[2], base + t[1]});
  original.bodies = {{"shell", mesh, 0}};
  Simplification done;
  const mc::Specimen simple = simplified(original, 2, done);
  EXPECT_THAT(done.bodies[0].kept, HasSubstr("pass through itself near ("));
  EXPECT_EQ(simple.bodies[0].mesh.triangles, mesh.triangles);
  EXPECT_THAT(warnings_of(original, done), ElementsAre(HasSubstr("stays as it is")));
}

TEST(SimplifySpecimen, RefusesTolerancesThatCannotBeMeant) {
  Simplification done;
  for (const double tolerance : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(simplified(ball_on_silicon(), tolerance, done), UsageError);
  try {
    simplified(ball_on_silicon(), 45, done);
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_THAT(e.what(), HasSubstr("45.0 nm leaves nothing of ball, which is 40.0 nm across"));
  }
  EXPECT_THROW(simplified(rough(), 60, done), UsageError);
  simplified(rough(), 30, done);
  EXPECT_THAT(warnings_of(rough(), done), ElementsAre(HasSubstr("may vanish")));
  // A plane through the middle is within half of the relief.
  const auto [low, high] = std::ranges::minmax(rough().height_field->field.z_nm.data());
  simplified(rough(), 0.51 * (high - low), done);
  EXPECT_THAT(warnings_of(rough(), done), ElementsAre(HasSubstr("may vanish")));
  simplified(rough(), 0.49 * (high - low), done);
  EXPECT_THAT(warnings_of(rough(), done), IsEmpty());
  mc::Specimen bare = silicon();
  bare.substrate = mc::Substrate{};
  simplified(bare, 1, done);
  EXPECT_THAT(warnings_of(bare, done), ElementsAre(HasSubstr("no triangles")));
}

// Mean square difference of two images, beyond what scatter makes of it: relative to the mean.
struct Difference {
  double beyond, scatter;  // `scatter`: four standard deviations of the first by chance
};

Difference difference(const mc::SimulationResult& a, const mc::SimulationResult& b,
                      std::size_t detector, int pixels) {
  const double n = double(pixels) * pixels;
  double mean = 0, squares = 0, variance = 0;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      const mc::Estimate p = a.yield(detector, x, y), q = b.yield(detector, x, y);
      mean += p.mean / n;
      squares += (p.mean - q.mean) * (p.mean - q.mean) / n;
      variance += (p.standard_error * p.standard_error + q.standard_error * q.standard_error) / n;
    }
  return {(squares - variance) / (mean * mean), 4 * variance * std::sqrt(2 / n) / (mean * mean)};
}

TEST(SimplifySpecimen, ChangesImagesByLittleForASmallTolerance) {
  constexpr int pixels = 12;
  constexpr double bound = 0.02;  // of the mean, rms over the pixels, besides scatter
  const mc::Specimen original = rough();
  Simplification done;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{800};
  options.threads = 2;
  const auto image = [&](const mc::Specimen& s, std::uint64_t seed) {
    options.seed = seed;
    return mc::simulate(mc::Scene(s, {}, scan(pixels, 4)), options);
  };
  const auto all = image(original, 1);
  const auto small = image(simplified(original, 0.05, done), 2);
  EXPECT_LT(done.bodies[0].triangles_after, done.bodies[0].triangles_before / 4);
  const auto large = image(simplified(original, 2, done), 3);
  for (const std::size_t detector : {0u, 1u}) {
    const Difference d = difference(all, small, detector, pixels);
    EXPECT_LE(d.beyond, d.scatter + bound * bound) << "detector " << detector;
  }
  const Difference d = difference(all, large, 0, pixels);
  EXPECT_GT(d.beyond, d.scatter + bound * bound) << "the comparison sees what is left out";
}

SimulateJob rough_job() {
  SimulateJob job = small_job();
  job.scene.specimen = rough();
  job.scene.specimen.height_field->field = make_rough({30, 30, 0.5}, 2, 8, 7);  // scenes soon built
  return job;
}

TEST(MeshTolerance, OffOrZeroGivesTheSameBytes) {
  const TemporaryFolder folder;
  SimulateJob job = rough_job();
  job.outputs = {folder.path() / "a.exr"};
  const SimulateSummary off = run(job);
  EXPECT_EQ(off.simplification.tolerance_nm, 0);
  job.scene.mesh_tolerance_nm = 0;
  job.outputs = {folder.path() / "b.exr"};
  run(job);
  EXPECT_TRUE(bytes_of(folder.path() / "a.exr") == bytes_of(folder.path() / "b.exr"));
  job.scene.mesh_tolerance_nm = 0.3;
  job.outputs = {folder.path() / "c.exr"};
  const SimulateSummary on = run(job);
  EXPECT_LT(on.scene.triangles, off.scene.triangles / 4);
  EXPECT_FALSE(io::read_image(folder.path() / "a.exr").find("SE")->values ==
               io::read_image(folder.path() / "c.exr").find("SE")->values);
}

TEST(MeshTolerance, IsRecordedAndGivesTheSameBytesForAnyThreads) {
  const TemporaryFolder folder;
  SimulateJob job = rough_job();
  job.scene.mesh_tolerance_nm = 0.3;
  job.outputs = {folder.path() / "a.exr"};
  std::vector<std::string> notes;
  const SimulateSummary summary =
      run(job, {.on_note = [&](const std::string& note) { notes.push_back(note); }});
  EXPECT_THAT(notes, testing::Contains("leaving out detail below 0.300 nm"));
  auto metadata = io::read_image(job.outputs[0]).metadata;
  EXPECT_EQ(metadata["simulation.mesh_tolerance_nm"], "0.3");
  EXPECT_EQ(metadata["simplified.1"], describe(summary.simplification.bodies[0]));
  const auto json = nlohmann::json::parse(bytes_of(folder.path() / "a.run.json"));
  EXPECT_EQ(json["simplification"]["tolerance_nm"], 0.3);
  EXPECT_LE(json["simplification"]["bodies"][0]["deviation_nm"], 0.3);
  EXPECT_LT(json["simplification"]["bodies"][0]["triangles_after"],
            json["simplification"]["bodies"][0]["triangles_before"]);
  EXPECT_GE(json["simplification"]["seconds"], 0);
  job.execution.threads = 3;
  job.outputs = {folder.path() / "b.exr"};
  run(job);
  EXPECT_TRUE(bytes_of(folder.path() / "a.exr") == bytes_of(folder.path() / "b.exr"));
}

}  // namespace
}  // namespace surf::workflow
