// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/compare_job.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "changing_surface.h"
#include "heard.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/model/model_file.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/sem/slope_model.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::ChangingSurface;
using test::measured;
using test::Measuring;
using test::WallShape;
using testing::HasSubstr;

class CompareJobTest : public testing::Test {
 protected:
  static constexpr int px = 72;

  CompareJobTest() : was_(31, 144, WallShape::rounded), is_(was_) { is_.add(70, 75, 20, 2); }

  static Measuring scan(std::uint64_t seed, double x_nm = 0) {
    Measuring m;
    m.width = m.height = px;
    m.seed = seed, m.x_nm = x_nm, m.y_nm = -x_nm;
    return m;
  }

  CompareJob job(const HeightField& before, const HeightField& after) const {
    CompareJob out;
    out.before = MeasuredSurface{before, {}};
    out.after = MeasuredSurface{after, {}};
    out.before_file = path("before.txt"), out.after_file = path("after.txt");
    io::write_height_field(out.before_file, before);
    io::write_height_field(out.after_file, after);
    out.parameters.simulations = 60;
    out.folder = path("result");
    out.picture = false;
    return out;
  }

  std::filesystem::path path(const char* name) const { return folder_.path() / name; }
  nlohmann::json report() const {
    return nlohmann::json::parse(io::read_file(path("result") / "report.json"));
  }

  test::TemporaryFolder folder_;
  ChangingSurface was_, is_;
};

TEST_F(CompareJobTest, FindsAChangeAndWritesIt) {
  const CompareSummary s = run(job(measured(was_, scan(1)), measured(is_, scan(2, 1.3))));
  EXPECT_EQ(s.verdict, CompareVerdict::changed);
  EXPECT_TRUE(s.reasons.empty());
  ASSERT_GE(s.changes.places.size(), 1u);
  EXPECT_NEAR(s.changes.places[0].centre_nm.x, 70, 4);
  EXPECT_NEAR(s.changes.places[0].mean, 2, 0.5);
  EXPECT_EQ(s.deviation_from, "the difference");
  EXPECT_EQ(report()["verdict"], "changed");
  EXPECT_EQ(report()["places"].size(), s.changes.places.size());
  EXPECT_NEAR(report()["registration"]["shift_nm"][0], 1.3, 0.15);
  const Image image = io::read_image(path("result") / "change.vti");
  for (const char* name : {"difference", "deviation", "probability", "place", "before", "after"})
    EXPECT_NE(image.find(name), nullptr) << name;
  EXPECT_THAT(io::read_file(path("result") / "places.csv"), HasSubstr("place,x_nm,y_nm,area_nm2"));
}

TEST_F(CompareJobTest, WritesTheSameBytesWithAnyThreads) {
  CompareJob one = job(measured(was_, scan(1)), measured(is_, scan(2, 1.3)));
  one.threads = 1;
  CompareJob three = one;
  three.threads = 3;
  three.folder = path("again");
  run(one), run(three);
  for (const char* file : {"change.vti", "places.csv", "report.json"})
    EXPECT_EQ(io::read_file(path("result") / file), io::read_file(path("again") / file)) << file;
}

TEST_F(CompareJobTest, OtherSpecimensGetAVerdictAndNoSurface) {
  const ChangingSurface other(77, 144, WallShape::rounded);
  const CompareSummary s = run(job(measured(was_, scan(1)), measured(other, scan(2))));
  EXPECT_EQ(s.verdict, CompareVerdict::not_registered);
  EXPECT_FALSE(s.reasons.empty());
  EXPECT_EQ(report()["verdict"], "not registered");
  EXPECT_FALSE(report()["trusted"]);
  EXPECT_FALSE(report().contains("places"));
  EXPECT_FALSE(std::filesystem::exists(path("result") / "change.vti"));
}

TEST_F(CompareJobTest, OtherSpecimensThatAreToldToLieRightAreDoubted) {
  const ChangingSurface other(77, 144, WallShape::rounded);
  CompareJob wrong = job(measured(was_, scan(1)), measured(other, scan(2)));
  wrong.parameters.registered = true;
  wrong.parameters.before_deviation_nm = wrong.parameters.after_deviation_nm = 0.1;
  const CompareSummary s = run(wrong);
  EXPECT_THAT(s.reasons, testing::ElementsAre(HasSubstr("same place of the same specimen")));
}

TEST_F(CompareJobTest, DeviationsOfFilesCountAndTooSmallOnesAreWidened) {
  const HeightField before = measured(was_, scan(1)), after = measured(was_, scan(2, 1.3));
  Image image;
  image.placement() = after.placement();
  for (const char* name : {"z_nm", "deviation_nm"}) {
    Grid<float> values(px, px, 0.15F);
    if (name[0] == 'z')
      for (std::size_t i = 0; i < values.size(); ++i)
        values.data()[i] = static_cast<float>(after.z_nm.data()[i]);
    image.channels.push_back({name, "nm", values});
  }
  io::write_image(path("surface.vti"), image);
  std::vector<std::string> notes;
  const ComparedSurface read = read_compared_surface(path("surface.vti"), {}, {}, notes);
  ASSERT_TRUE(std::holds_alternative<MeasuredSurface>(read));
  const auto& surface = std::get<MeasuredSurface>(read);
  ASSERT_EQ(surface.deviation_nm.size(), surface.field.z_nm.size());
  EXPECT_NEAR(surface.deviation_nm(3, 3), 0.15, 1e-6);
  CompareJob told = job(before, after);
  told.after = surface;
  told.parameters.before_deviation_nm = 0.15;
  test::Heard heard;
  const CompareSummary s = run(told, heard.reporter());
  EXPECT_GT(s.changes.spread, 1.3);
  EXPECT_THAT(heard.warnings, testing::ElementsAre(HasSubstr("deviations are widened")));
  EXPECT_GE(s.changes.deviation(10, 10), 0.99 * s.changes.spread * 0.15 * std::sqrt(2.0));
}

TEST_F(CompareJobTest, AMeshIsWhatIsExpected) {
  Measuring fine = scan(3);
  fine.noise_nm = 0;
  const HeightField expected = measured(was_, fine);
  io::write_mesh(path("part.ply"), height_field_sheet(expected));
  std::vector<std::string> notes;
  const ComparedSurface mesh = read_compared_surface(path("part.ply"), {}, {}, notes);
  ASSERT_TRUE(std::holds_alternative<TriangleMesh>(mesh));
  CompareJob against = job(expected, measured(is_, scan(4, 1.3)));
  against.before = mesh;
  against.parameters.after_deviation_nm = 0.3;
  const CompareSummary s = run(against);
  ASSERT_GE(s.changes.places.size(), 1u);
  EXPECT_NEAR(s.changes.places[0].centre_nm.y, 75, 4);
  CompareJob both = against;
  both.after = std::get<TriangleMesh>(mesh);
  EXPECT_THROW(run(both), UsageError);
}

TEST_F(CompareJobTest, AnImageIsComparedWithWhatTheSurfacePredicts) {
  TrainedModel model;
  model.scope = {2, "Si", 1000, 0};
  model.parameters = SlopeModelParameters{SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}}};
  model.record.range.slope_deg_max = 89;
  io::write_model(path("si.json"), model);
  Measuring quiet = scan(5);
  quiet.noise_nm = 0;
  const HeightField before = measured(was_, quiet);
  is_.add(30, 110, 16, 12);
  const HeightField after = measured(is_, quiet);
  PlacedImage image{after.placement(), make_model(model)->predict(after).front(), {}};
  const Grid<double> noise = test::blurred_noise(px, px, 0, 8);
  for (std::size_t i = 0; i < noise.size(); ++i)
    image.values.data()[i] = 100 * image.values.data()[i] + 20 + 1.5 * noise.data()[i];
  CompareJob of_image = job(before, after);
  of_image.after = image;
  of_image.model.file = path("si.json");
  of_image.parameters.registered = true;
  const CompareSummary s = run(of_image);
  EXPECT_NEAR(s.gain, 100, 5);
  EXPECT_EQ(s.unit, "%");
  ASSERT_GE(s.changes.places.size(), 1u);
  bool there = false;
  for (const ChangedPlace& p : s.changes.places)
    there = there || (std::abs(p.centre_nm.x - 30) < 12 && std::abs(p.centre_nm.y - 110) < 12);
  EXPECT_TRUE(there);
  EXPECT_TRUE(report().contains("image"));
}

TEST_F(CompareJobTest, BadParametersAreRefused) {
  CompareJob bad = job(measured(was_, scan(1)), measured(is_, scan(2)));
  bad.parameters.false_alarms = 0;
  EXPECT_THROW(run(bad), UsageError);
  bad.parameters.false_alarms = 0.05;
  bad.folder = path("before.txt");
  EXPECT_THROW(run(bad), UsageError);
  bad.folder = path("result");
  CancelToken token;
  token.cancel();
  Reporter reporter;
  reporter.cancel = &token;
  EXPECT_THROW(run(bad, reporter), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
