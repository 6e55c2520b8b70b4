// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/sample_job.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/tip_file.h"
#include "surf/reconstruction/sample_surfaces.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

SampleJob small(const std::string& name, const fs::path& folder) {
  SampleJob job;
  job.name = name;
  job.folder = folder;
  job.width = 40;
  job.height = 24;
  job.electrons = 3;
  job.cascades = 2048;
  job.threads = 2;
  return job;
}

TEST(SampleJob, HasASceneForEverySurface) {
  std::set<std::string> names;
  for (const SampleScene& scene : sample_scenes()) names.insert(scene.name);
  for (const SampleSurface& surface : sample_surfaces()) EXPECT_TRUE(names.contains(surface.name));
}

TEST(SampleJob, SaysWhatIsTrue) {
  for (const SampleScene& scene : sample_scenes()) {
    SCOPED_TRACE(scene.name);
    const test::TemporaryFolder folder;
    const SampleSummary summary = run(small(scene.name, folder.path()));
    ASSERT_TRUE(summary.complete);
    EXPECT_EQ(summary.written.size(), 6u);
    const auto truth = nlohmann::json::parse(bytes_of(folder.path() / "truth.json"));
    const HeightField scan = io::read_height_field(folder.path() / "afm.gsf").field;
    const HeightField surface = io::read_height_field(folder.path() / "truth.gsf").field;
    const Image sem = io::read_image(folder.path() / "sem.tif"),
                yields = io::read_image(folder.path() / "truth_sem.exr");

    EXPECT_EQ(surface.pitch_x_nm, 10);
    EXPECT_EQ(sem.pitch_x_nm, 10);
    EXPECT_EQ(scan.pitch_x_nm, 20);
    EXPECT_EQ(sem.origin_x_nm, 0);
    EXPECT_EQ(scan.origin_x_nm, 0);
    const Grid<float>& signal = sem.find("signal")->values;
    const double expected = 900 * double{yields.find("SE")->values(7, 5)} +
                            300 * double{yields.find("BSE")->values(7, 5)} + 120;
    EXPECT_NEAR(signal(7, 5), expected, 1e-3 * expected);

    // Through the map, without tilt and offset, the scan lies on or above the surface, which it
    // touches somewhere.
    const auto m = truth.at("sem_to_afm").get<std::vector<double>>();
    const Affine map{m[0], m[1], m[2], m[3], m[4], m[5]};
    EXPECT_EQ(map, summary.sem_to_afm);
    const double per_degree = std::acos(-1.0) / 180;
    double least = 1e9, most = -1e9;
    for (int y = 0; y < surface.z_nm.height(); ++y)
      for (int x = 0; x < surface.z_nm.width(); ++x) {
        const Point2 p = map({surface.x_nm(x), surface.y_nm(y)});
        const int column = static_cast<int>(std::lround(p.x / 20)),
                  row = static_cast<int>(std::lround(p.y / 20));
        ASSERT_GE(std::min(column, row), 14);  // the margins
        ASSERT_LT(column, scan.z_nm.width() - 14);
        ASSERT_LT(row, scan.z_nm.height() - 14);
        if (std::hypot(p.x - column * 20, p.y - row * 20) > 1.5) continue;
        const double level = std::tan(scene.tilt_x_deg * per_degree) * column * 20 +
                             std::tan(scene.tilt_y_deg * per_degree) * row * 20 +
                             scene.afm_offset_nm;
        const double above = scan.z_nm(column, row) - level - surface.z_nm(x, y);
        least = std::min(least, above), most = std::max(most, above);
      }
    constexpr double noise_and_place = 7;  // 4 standard deviations, and 1.5 nm along a wall
    EXPECT_GT(least, -noise_and_place);
    EXPECT_LT(least, noise_and_place);
    EXPECT_LT(most, 120);
    EXPECT_EQ(io::read_tip(folder.path() / "truth_tip.gsf").pitch_x_nm, 20);
  }
}

TEST(SampleJob, DependsOnTheSeedAndNotOnThreads) {
  const test::TemporaryFolder a, b, c;
  SampleJob job = small("pads", a.path());
  run(job);
  job.folder = b.path(), job.threads = 1;
  run(job);
  job.folder = c.path(), job.seed = 2;
  run(job);
  for (const char* name :
       {"afm.gsf", "sem.tif", "truth.gsf", "truth_tip.gsf", "truth_sem.exr", "truth.json"})
    EXPECT_EQ(bytes_of(a.path() / name), bytes_of(b.path() / name)) << name;
  for (const char* name : {"afm.gsf", "sem.tif", "truth_sem.exr"})
    EXPECT_NE(bytes_of(a.path() / name), bytes_of(c.path() / name)) << name;
  // Not only for the seed that is written in them.
  const auto heights = [](const fs::path& file) { return io::read_height_field(file).field.z_nm; };
  const auto signal = [](const fs::path& file) {
    return io::read_image(file).find("signal")->values;
  };
  EXPECT_NE(heights(a.path() / "afm.gsf"), heights(c.path() / "afm.gsf"));
  EXPECT_NE(signal(a.path() / "sem.tif"), signal(c.path() / "sem.tif"));
}

TEST(SampleJob, MakesWhatAModelDoesNotKnow) {
  const test::TemporaryFolder usual, other;
  SampleJob job = small("pads", usual.path());
  run(job);
  job.folder = other.path();
  job.physics.elastic = mc::ElasticModel::browning;
  job.tip_lean_deg = 12;
  job.tip_azimuth_deg = 90;
  job.gain_drift = 0.2;
  run(job);
  // The tip is wider above, as the structuring function is deeper below its point reflected.
  const Tip tip = io::read_tip(other.path() / "truth_tip.gsf");
  const int x = tip.apex_x, y = tip.apex_y, away = std::min(y, tip.z_nm.height() - 1 - y);
  ASSERT_GT(away, 3);
  EXPECT_LT(tip.z_nm(x, y + away), 1.2 * tip.z_nm(x, y - away));
  const auto truth = nlohmann::json::parse(bytes_of(other.path() / "truth.json"));
  EXPECT_EQ(truth.at("afm").at("tip").at("lean_deg"), 12);
  EXPECT_THAT(std::string(truth.at("sem").at("physics")), testing::HasSubstr("browning"));
  // The gain at the corner is 1, a quarter along the diagonal 1.2.
  const Image sem = io::read_image(other.path() / "sem.tif"),
              yields = io::read_image(other.path() / "truth_sem.exr");
  const auto gain = [&](int column, int row) {
    return (double{sem.find("signal")->values(column, row)} - 120) /
           (900 * double{yields.find("SE")->values(column, row)} +
            300 * double{yields.find("BSE")->values(column, row)});
  };
  EXPECT_NEAR(gain(0, 0), 1, 1e-4);
  EXPECT_NEAR(gain(job.width / 2, 0), 1.2, 1e-3);
  EXPECT_NE(bytes_of(usual.path() / "truth_sem.exr"), bytes_of(other.path() / "truth_sem.exr"));

  const test::TemporaryFolder third;
  job.folder = third.path();
  job.gain_drift = 0;
  job.spot_nm = 8;
  job.detector = "in-lens";
  job.scan_drift_px = 3;
  job.line_jitter_px = 0.5;
  run(job);
  const Image narrow = io::read_image(third.path() / "truth_sem.exr");
  const auto mean = [](const Image& image, const char* channel) {
    double sum = 0;
    for (const float v : image.find(channel)->values.data()) sum += v;
    return sum;
  };
  EXPECT_LT(mean(narrow, "SE-in-lens"), 0.8 * mean(narrow, "SE"));
  EXPECT_NE(bytes_of(other.path() / "afm.gsf"), bytes_of(third.path() / "afm.gsf"));
  const auto record = nlohmann::json::parse(bytes_of(third.path() / "truth.json"));
  EXPECT_EQ(record.at("sem").at("spot_nm"), 8);
  EXPECT_EQ(record.at("sem").at("detector"), "in-lens");
  EXPECT_EQ(record.at("sem").at("line_jitter_px"), 0.5);
  EXPECT_EQ(record.at("afm").at("drift_px"), 3);
  job.detector = "quadrants";
  EXPECT_THROW(run(job), UsageError);
  job.detector.clear();
  job.tip_lean_deg = 40;  // more than the half angle
  EXPECT_THROW(run(job), UsageError);
}

TEST(SampleJob, CoversTheSpecimenWithAFilm) {
  const test::TemporaryFolder own, other;
  const auto mean = [](const fs::path& folder, const char* channel) {
    double sum = 0;
    const Image image = io::read_image(folder / "truth_sem.exr");
    for (const float v : image.find(channel)->values.data()) sum += v;
    return sum;
  };
  SampleJob job = small("pads", own.path());
  job.electrons = 30;
  run(job);
  const double bare = mean(own.path(), "BSE");
  job.film = "Si";  // changes nothing
  job.folder = other.path();
  run(job);
  EXPECT_NEAR(mean(other.path(), "BSE"), bare, 0.06 * bare);  // 5 standard errors
  job.film = "Au";
  run(job);
  EXPECT_GT(mean(other.path(), "BSE"), 1.15 * bare);
  const auto truth = nlohmann::json::parse(bytes_of(other.path() / "truth.json"));
  EXPECT_EQ(truth.at("sem").at("film"), "Au");
  EXPECT_EQ(truth.at("sem").at("film_nm"), 2);
  job.film = "unobtainium";
  EXPECT_THROW(run(job), UsageError);
}

TEST(SampleJob, LeavesNothingWhenCancelledOrRefused) {
  const test::TemporaryFolder folder;
  CancelToken cancel;
  cancel.cancel();
  EXPECT_FALSE(run(small("islands", folder.path()), {.cancel = &cancel}).complete);
  SampleJob job = small("islands", folder.path());
  job.width = 8;
  EXPECT_THROW(run(job), UsageError);
  job = small("islands", folder.path());
  job.electrons = 0;
  EXPECT_THROW(run(job), UsageError);
  EXPECT_THROW(run(small("island", folder.path())), UsageError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SampleJob, GoesOnWhereItWasStopped) {
  const test::TemporaryFolder whole, stopped, cache;
  SampleJob job = small("pads", whole.path());
  job.cache = cache.path();         // one library for all
  job.width = 72, job.height = 64;  // several units of work
  job.threads = 1;
  ASSERT_TRUE(run(job).complete);

  job.folder = stopped.path();
  CancelToken cancel;
  const SampleSummary first = run(job, {.on_progress =
                                            [&](double, double, std::string_view things) {
                                              if (things == "primaries") cancel.cancel();
                                            },
                                        .cancel = &cancel});
  EXPECT_FALSE(first.complete);
  EXPECT_TRUE(first.written.empty());
  ASSERT_TRUE(fs::exists(first.checkpoint));
  EXPECT_EQ(first.checkpoint.parent_path(), stopped.path());

  SampleJob other = job;  // neither takes the work of the first nor touches it
  other.seed = 2;
  CancelToken at_once;
  at_once.cancel();
  EXPECT_TRUE(run(other, {.cancel = &at_once}).checkpoint.empty());
  ASSERT_TRUE(fs::exists(first.checkpoint));

  std::vector<std::string> notes;
  double begun_at = 0;
  const auto progress = [&](double done, double, std::string_view things) {
    if (things == "primaries") begun_at = begun_at > 0 ? begun_at : done;
  };
  job.threads = 2;
  const SampleSummary second =
      run(job, {.on_progress = progress,
                .on_note = [&](const std::string& note) { notes.push_back(note); }});
  ASSERT_TRUE(second.complete);
  EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("resuming")));
  EXPECT_GT(begun_at, 1024 * job.electrons);  // more than its first unit
  EXPECT_FALSE(fs::exists(first.checkpoint));
  for (const char* name :
       {"afm.gsf", "sem.tif", "truth.gsf", "truth_tip.gsf", "truth_sem.exr", "truth.json"})
    EXPECT_EQ(bytes_of(whole.path() / name), bytes_of(stopped.path() / name)) << name;
}

TEST(SampleJob, KeepsTheSimulationWhereItsFilesCannotBeWritten) {
  const test::TemporaryFolder folder;
  SampleJob job = small("pads", folder.path());
  const auto block = [&](double, double, std::string_view) {
    fs::create_directories(folder.path() / "truth.gsf" / "in the way");
  };
  std::vector<std::string> notes;
  EXPECT_THROW(run(job, {.on_progress = block,
                         .on_note = [&](const std::string& note) { notes.push_back(note); }}),
               FileError);
  EXPECT_THAT(notes,
              testing::ElementsAre(testing::HasSubstr("simulating"),
                                   testing::HasSubstr("the same command goes on from there")));
  fs::remove_all(folder.path() / "truth.gsf");
  EXPECT_TRUE(run(job).complete);
}

}  // namespace
}  // namespace surf::workflow
