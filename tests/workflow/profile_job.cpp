// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/profile_job.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/signal_detectors.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double energy_ev = 300, pixel_nm = 2, image_gain = 500, image_offset = 40;

/// Lines of silicon, 40 nm wide and 30 nm high, at 300 eV.
class ProfileJobTest : public testing::Test {
 protected:
  static PlacedImage lines(double angle_deg, double tilt_deg = 0,
                           const std::string& signal = "SE") {
    const FeatureShape shape{FeatureKind::line, 40, 100, {30, angle_deg, 2, 2}};
    mc::Specimen specimen;
    specimen.materials = {io::find_material("Si", "test")};
    specimen.bodies.push_back({"lines", feature_mesh(shape, 400), 0});
    mc::Beam beam;
    beam.energy_ev = energy_ev;
    beam.tilt_deg = tilt_deg;
    mc::Scan scan;
    scan.width = 90;
    scan.height = 24;
    scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
    mc::SimulationOptions options;
    options.budget = mc::ElectronsPerPixel{60};
    options.seed = 5;
    for (const mc::Detector& d : detectors_of(signal, "test")) options.detectors.push_back(d);
    return picture(mc::simulate(mc::Scene(specimen, beam, scan), options, {}), scan,
                   signal == "SE" ? 0 : 2);
  }

  /// A hole 44 nm wide and 30 nm deep.
  static PlacedImage hole(double tilt_deg = 0, double azimuth_deg = 0) {
    const FeatureShape shape{FeatureKind::hole, 44, 0, {30, 84, 2, 2}};
    mc::Specimen specimen;
    specimen.materials = {io::find_material("Si", "test")};
    specimen.bodies.push_back({"hole", feature_mesh(shape, 400), 0});
    mc::Beam beam;
    beam.energy_ev = energy_ev;
    beam.tilt_deg = tilt_deg, beam.azimuth_deg = azimuth_deg;
    mc::Scan scan;
    scan.width = scan.height = 60;
    scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
    scan.center_x_nm = 2;
    mc::SimulationOptions options;
    options.budget = mc::ElectronsPerPixel{150};
    options.seed = 6;
    return picture(mc::simulate(mc::Scene(specimen, beam, scan), options, {}), scan, 0);
  }

  static PlacedImage picture(const mc::SimulationResult& done, const mc::Scan& scan,
                             std::size_t detector) {
    PlacedImage image;
    image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
    image.values = Grid<double>(scan.width, scan.height);
    for (int y = 0; y < scan.height; ++y)
      for (int x = 0; x < scan.width; ++x)
        image.values(x, y) = image_offset + image_gain * done.yield(detector, x, y).mean;
    return image;
  }

  ProfileJobTest() {
    static const PlacedImage image = lines(84);
    job_.sem.image = image;
    job_.sem.file = "lines.tif";
    io::write_text(folder_.path() / "lines.tif", "the image");
    job_.sem.file = folder_.path() / "lines.tif";
    job_.material = io::find_material("Si", "test");
    job_.energy_ev = energy_ev;
    job_.height_nm = 30;
    job_.angle_deg = 85, job_.angle_range_deg = 3;
    job_.top_radius_nm = job_.foot_radius_nm = 2;
    job_.electrons = 200, job_.middle_electrons = 10'000;
    job_.rounds = 1;
    job_.picture = false;
    static const test::TemporaryFolder cascades;
    job_.cache = cascades.path();
    job_.folder = folder_.path() / "result";
  }

  test::TemporaryFolder folder_;
  ProfileJob job_;
};

TEST_F(ProfileJobTest, MeasuresLinesAndSaysHowWell) {
  const ProfileSummary s = run(job_);
  const Measured width = s.fit.left[profile_width], angle = s.fit.left[profile_angle];
  EXPECT_NEAR(width.value, 40, 1.2);
  EXPECT_GT(width.standard_error, 0.05);
  EXPECT_LT(width.standard_error, 1);
  EXPECT_NEAR(angle.value, 84, std::min(4.0, 3 * angle.standard_error));
  EXPECT_NEAR(s.fit.sights.front().gain, image_gain, 0.2 * image_gain);
  EXPECT_NEAR(s.pitch_nm, 100, 1);
  EXPECT_NEAR(s.threshold_widths_nm.front().value, 40, 5);

  const auto json = nlohmann::json::parse(io::read_file(job_.folder / "profile.json"));
  EXPECT_EQ(json["width_nm"]["value"], width.value);
  EXPECT_EQ(json["parameters"]["profile.height_nm"], "30");
  EXPECT_EQ(json["trusted"], s.reasons.empty());
  for (const char* file :
       {"edges.csv", "profiles.csv", "spectrum.csv", "surface.gsf", "surface.vti"})
    EXPECT_TRUE(fs::exists(job_.folder / file)) << file;
  // The surface: lines 30 nm high, about which nothing is known at the walls alone.
  EXPECT_EQ(s.surface.z_nm.width(), 90);
  const auto [low, high] = std::ranges::minmax(s.surface.z_nm.data());
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, 30);
  const auto middle = static_cast<int>(s.fit.edges()[0].smooth_nm[12] / pixel_nm + 0.5);
  EXPECT_GT(s.deviation_nm(middle, 12), 1);
  EXPECT_LT(s.deviation_nm(middle + 10, 12), 0.01);
  // The image cuts off two lines, of which it shows a wall each, at 80 nm from its middle.
  for (const int end : {0, 89}) EXPECT_EQ(s.surface.z_nm(end, 12), 30) << end;
  for (const int wall : {4, 85}) {
    EXPECT_GT(s.deviation_nm(wall, 12), 1) << wall;
    EXPECT_LT(s.deviation_nm(wall, 12), 20) << wall;
  }
}

TEST_F(ProfileJobTest, AScanTellsTheHeight) {
  HeightField scan{{5, 5, 0, 0}, Grid<double>(60, 40)};
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      scan.z_nm(x, y) = 7 + (x / 15 % 2 == 0 ? 31.5 : 0) + 0.1 * ((x * 7 + y * 3) % 5);
  job_.scan = scan;
  job_.height_nm = 0;
  job_.electrons = 10, job_.middle_electrons = 10;
  job_.folder.clear();
  const ProfileSummary s = run(job_);
  ASSERT_TRUE(s.scan_height_nm);
  EXPECT_NEAR(s.scan_height_nm->value, 31.5, 0.2);
  EXPECT_GT(s.scan_height_nm->standard_error, 0.1);  // scans are calibrated to half a per cent
  EXPECT_NEAR(s.fit.left[profile_height].value, 31.5, 1);
  for (double& z : job_.scan->z_nm.data()) z = 7;
  EXPECT_THROW(run(job_), InvalidInput);
}

// Two flanks of the tip meet in each gap.
TEST_F(ProfileJobTest, AScanWhoseTipDoesNotReachTheGroundTellsNoHeight) {
  HeightField scan{{2, 2, 0, 0}, Grid<double>(90, 40)};
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 90; ++x) {
      const double from_middle = 2 * std::abs(x % 30 - 15);
      scan.z_nm(x, y) = std::min(100.0, 40 + 4 * from_middle) + 0.1 * ((x * 7 + y * 3) % 5);
    }
  job_.scan = scan;
  job_.height_nm = 0;
  job_.folder.clear();
  EXPECT_THAT([&] { run(job_); },
              ThrowsMessage<InvalidInput>(HasSubstr("does not reach the ground")));
}

TEST_F(ProfileJobTest, FurtherImagesHaveTheirOwnTiltsAndSignals) {
  job_.electrons = 10, job_.middle_electrons = 10;
  job_.folder.clear();
  job_.views.resize(2);
  job_.views[0].image = job_.views[1].image = job_.sem.image;
  job_.view_settings.tilts_deg = {0, 4, 0};
  job_.view_settings.azimuths_deg = {0, 180, 0};
  job_.view_settings.signals = {"SE", "SE", "BSE-right"};
  const ProfileSummary s = run(job_);
  ASSERT_EQ(s.fit.sights.size(), 3u);
  EXPECT_GT(s.fit.sights[1].tilt_deg.value, 0);    // as it is in truth
  EXPECT_LT(s.fit.sights[1].tilt_deg.value, 4.5);  // as it was said to be
  EXPECT_EQ(s.fit.sights[2].tilt_deg.value, 0);
  // One library for the first, and one for each wall of the others.
  EXPECT_EQ(s.simulated % 5, 0);

  const auto refused = [&](const char* what) {
    EXPECT_THAT([&] { run(job_); }, ThrowsMessage<Error>(HasSubstr(what)));
  };
  job_.view_settings.tilts_deg = {1, 4, 0};
  refused("beam.tilt");
  job_.view_settings.tilts_deg = {1, 2, 3, 4};
  refused("2 further SEM images");
  job_.view_settings.tilts_deg = {4, 0};
  job_.view_settings.signals = {"SE", "CL"};
  refused("view_signal");
  job_.view_settings.signals = {"SE", "side"};
  job_.along_x = true;
  refused("along_x");
}

TEST_F(ProfileJobTest, TiltedImagesTellAHolesDepth) {
  job_.kind = FeatureKind::hole;
  job_.sem.image = hole();
  job_.height_nm = 26, job_.height_error_nm = 4;
  job_.views.resize(2);
  job_.views[0].image = hole(15, 90);
  job_.views[1].image = hole(15, 270);
  job_.view_settings.tilts_deg = {15, 15};
  job_.view_settings.azimuths_deg = {90, 270};
  job_.view_settings.tilt_error_deg = 0.1;
  job_.electrons = 30, job_.middle_electrons = 3000;
  job_.folder.clear();
  const ProfileSummary s = run(job_);
  const Measured depth = s.fit.left[profile_height], width = s.fit.left[profile_width];
  EXPECT_LT(depth.standard_error, 4);
  EXPECT_GT(depth.standard_error, 1);  // tiers of physics differ in where the bottom seems to end
  EXPECT_NEAR(depth.value, 30, 2.5 * depth.standard_error);
  EXPECT_NEAR(width.value, 44, 2);
  job_.view_settings.tilts_deg = {15, 0};
  job_.view_settings.signals = {"SE", "BSE-right"};
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<Error>(HasSubstr("all of SE or BSE")));
  job_.view_settings.signals = {"BSE-right", "SE"};
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<Error>(HasSubstr("all of SE or BSE")));
}

// What is hidden tells nothing, and was taken for a shallower hole.
TEST_F(ProfileJobTest, SaysThatTheBottomIsBadlySeen) {
  job_.kind = FeatureKind::hole;
  job_.sem.image = hole();
  job_.height_nm = 30, job_.height_error_nm = 0.5;
  job_.views.resize(1);
  job_.views[0].image = hole(50, 90);
  job_.view_settings.tilts_deg = {50};
  job_.view_settings.azimuths_deg = {90};
  job_.electrons = 10, job_.middle_electrons = 100, job_.rounds = 1;
  job_.folder.clear();
  std::vector<std::string> notes;
  Reporter reporter;
  reporter.on_note = [&](const std::string& note) { notes.push_back(note); };
  EXPECT_THAT(run(job_, reporter).reasons, testing::Contains(HasSubstr("hardly in sight")));
  EXPECT_THAT(notes, testing::Contains(HasSubstr("hardly in sight")));
  job_.views.clear();
  job_.view_settings = {};
  job_.height_nm = 60;
  EXPECT_THAT(run(job_).reasons, testing::Contains(HasSubstr("deeper than 1.2")));
}

TEST_F(ProfileJobTest, LinesAlongXAreTurnedAndThreadsChangeNothing) {
  job_.electrons = 30, job_.middle_electrons = 300;
  ProfileJob turned = job_;
  const PlacedImage& image = job_.sem.image;
  turned.sem.image.values = Grid<double>(image.values.height(), image.values.width());
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      turned.sem.image.values(y, x) = image.values(x, y);
  turned.folder.clear();
  turned.along_x = true;
  turned.threads = 1;
  job_.folder.clear();
  const ProfileSummary s = run(job_), t = run(turned);
  EXPECT_EQ(t.fit.left[profile_width].value, s.fit.left[profile_width].value);
  // Results lie as the image does.
  for (const auto& [along_y, along_x] : {std::pair(&s.surface.z_nm, &t.surface.z_nm),
                                         {&s.deviation_nm, &t.deviation_nm},
                                         {&s.fitted, &t.fitted}})
    for (int y = 0; y < along_y->height(); ++y)
      for (int x = 0; x < along_y->width(); ++x)
        ASSERT_EQ((*along_x)(y, x), (*along_y)(x, y)) << x << " " << y;
  EXPECT_EQ(t.surface.origin_y_nm, s.surface.origin_x_nm);
  ASSERT_EQ(t.edge_lines_nm.size(), s.edge_lines_nm.size());
  EXPECT_EQ(t.edge_lines_nm[0][5].y, s.edge_lines_nm[0][5].x);
}

TEST_F(ProfileJobTest, SaysThatNoProfileIsLikeTheImage) {
  // Dark bands on the ground, as nothing makes there.
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 90; ++x)
      if ((x > 14 && x < 26) || (x > 62 && x < 74)) job_.sem.image.values(x, y) = 150;
  job_.folder.clear();
  EXPECT_FALSE(run(job_).reasons.empty());
}

TEST_F(ProfileJobTest, RefusesWhatItCannotMeasure) {
  const auto refused = [&](const char* what) {
    EXPECT_THAT([&] { run(job_); }, ThrowsMessage<Error>(HasSubstr(what)));
  };
  job_.height_nm = 0;
  refused("profile.height");
  job_.height_nm = 30;
  job_.signal = "CL";
  refused("profile.signal");
  job_.signal = "SE";
  job_.sem.image.pitch_y_nm = 3;
  refused("not square");
  job_.sem.image.pitch_y_nm = pixel_nm;
  job_.material.name.clear();
  refused("specimen.material");
  job_.material = io::find_material("Si", "test");
  for (double& v : job_.sem.image.values.data()) v = 100;
  refused("no line is seen");
  EXPECT_FALSE(fs::exists(job_.folder));
}

TEST_F(ProfileJobTest, WallsThatCannotBeAreNotSimulated) {
  // Of the box's flattest walls the top would have no width.
  job_.height_nm = 150, job_.angle_deg = 85, job_.angle_range_deg = 6;
  job_.electrons = 10, job_.middle_electrons = 10;
  job_.folder.clear();
  EXPECT_NO_THROW(run(job_));
  job_.angle_deg = 60;
  EXPECT_THAT([&] { run(job_); }, ThrowsMessage<UsageError>(HasSubstr("profile.angle")));
}

TEST_F(ProfileJobTest, LeftAndRightAreTheFeaturesOwn) {
  // Of a gap the left wall has its ground at the right.
  job_.kind = FeatureKind::trench;
  job_.walls_apart = true;
  job_.electrons = 10, job_.middle_electrons = 10;
  // The gap in the middle: half a pitch aside. Its left wall is blurred.
  constexpr int period = 50, wall = 29;
  PlacedImage& image = job_.sem.image;
  const Grid<double> lines = image.values;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 90; ++x) {
      const int from = x + period / 2;
      image.values(x, y) = lines(from < 90 ? from : from - period, y);
      if (std::abs(x - wall) <= 5) image.values(x, y) = 0.5 * (image.values(x, y) + 700);
    }
  const ProfileSummary s = run(job_);
  const std::string csv = io::read_file(job_.folder / "profiles.csv");
  ASSERT_EQ(s.fit.sights.front().profiles.size(), 2u);
  EXPECT_EQ(csv.substr(csv.find('\n') + 1, 5),
            s.fit.sights.front().profiles[0].material_right ? "right" : "left,");
  ASSERT_EQ(s.fit.edges().size(), 2u);
  for (const FittedEdge& e : s.fit.edges())
    EXPECT_EQ(e.edge.material_right, e.place_nm.value > 90) << e.place_nm.value;
}

TEST_F(ProfileJobTest, SaysThatABeamWasTiltedToTheOtherSide) {
  job_.electrons = 40, job_.middle_electrons = 600;
  job_.rounds = 2;
  job_.folder.clear();
  job_.views.resize(1);
  job_.views[0].image = lines(84, 12);
  job_.view_settings.tilts_deg = {12};
  EXPECT_TRUE(run(job_).other_side.empty());
  job_.view_settings.azimuths_deg = {180};
  const ProfileSummary s = run(job_);
  EXPECT_EQ(s.other_side, std::vector<std::size_t>{1});
  EXPECT_THAT(s.reasons, testing::Contains(HasSubstr("beam.azimuth")));
}

TEST_F(ProfileJobTest, SaysThatQuadrantsAreExchanged) {
  job_.electrons = 40, job_.middle_electrons = 600;
  job_.rounds = 2;
  job_.folder.clear();
  job_.views.resize(1);
  job_.views[0].image = lines(84, 0, "BSE-right");
  job_.view_settings.signals = {"BSE-right"};
  EXPECT_TRUE(run(job_).other_side.empty());
  job_.view_settings.signals = {"BSE-left"};
  const ProfileSummary s = run(job_);
  EXPECT_EQ(s.other_side, std::vector<std::size_t>{1});
  EXPECT_THAT(s.reasons, testing::Contains(HasSubstr("exchanged")));
}

TEST_F(ProfileJobTest, CanBeInterrupted) {
  CancelToken token;
  Reporter listener;
  listener.cancel = &token;
  token.cancel();
  EXPECT_THROW(run(job_, listener), Interrupted);
  EXPECT_FALSE(fs::exists(job_.folder));
}

}  // namespace
}  // namespace surf::workflow
