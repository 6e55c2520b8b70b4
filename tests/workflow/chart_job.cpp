// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chart_job.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

#include "chart/chart_files.h"
#include "chart/compared_pixels.h"
#include "chart/pareto.h"
#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"
#include "surf/mesh/shapes.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

namespace fs = std::filesystem;

// Flat silicon without secondaries at 500 eV: short cascades.
ChartJob small_chart(const fs::path& folder, int pixels = 16) {
  ChartJob job;
  job.scene = small_job().scene;
  job.scene.specimen.bodies.clear();
  job.scene.scan.width = job.scene.scan.height = pixels;
  job.scene.beam.energy_ev = 500;
  job.scene.physics.secondaries = false;
  job.scene.budget = mc::ElectronsPerPixel{30};
  job.quick = true;
  job.threads = 2;
  job.folder = folder;
  return job;
}

// By id: the columns of chart.csv that do not hold times or memory, for each channel.
std::map<std::string, std::vector<std::string>> figures(const fs::path& csv) {
  std::map<std::string, std::vector<std::string>> out;
  std::istringstream in(io::read_file(csv));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> fields = io::split_csv_line(line);
    EXPECT_EQ(fields.size(), 17u) << line;
    const std::string id = fields[0] + " " + fields[3];
    fields.erase(fields.begin() + 4, fields.begin() + 7);
    EXPECT_TRUE(out.emplace(id, fields).second) << id;
  }
  return out;
}

TEST(ChartJob, EveryMethodIsThereAndMoreElectronsAreMoreAccurate) {
  const TemporaryFolder folder;
  ChartJob job = small_chart(folder.path());
  job.scene.physics.secondaries = true;
  const ChartSummary s = run(job);
  ASSERT_TRUE(s.complete);
  std::set<std::string> there;
  for (const ChartPoint& p : s.points) there.insert(p.family);
  for (const ChartFamily& f : chart_families())
    EXPECT_EQ(there.contains(f.name), f.name != "mesh-tolerance") << f.name;
  EXPECT_THAT(s.left_out, testing::Contains(HasSubstr("no height field")));

  const auto rows = figures(folder.path() / "chart.csv");
  EXPECT_EQ(rows.size(), 2 * s.points.size());
  std::map<std::string, const ChartPoint*> points;
  for (const ChartPoint& p : s.points) points[p.id] = &p;
  for (const char* family : {"direct", "replay"}) {
    const double few = 10, many = std::string(family) == "direct" ? 30 : 1000;
    for (const std::size_t channel : {0u, 1u}) {
      const ImageError& a = points.at(fmt::format("{}-{:g}", family, few))->channels[channel].error;
      const ImageError& b =
          points.at(fmt::format("{}-{:g}", family, many))->channels[channel].error;
      // 256 pixels: each is known to 1 / sqrt(2 * 256), and counts have longer tails.
      EXPECT_NEAR(std::log(a.rms / b.rms), 0.5 * std::log(many / few), 0.35) << family;
      EXPECT_NEAR(std::log(a.noise / b.noise), 0.5 * std::log(many / few), 0.2) << family;
      EXPECT_NEAR(a.rms, a.noise, 0.25 * a.noise);
      EXPECT_LT(std::abs(b.bias), 5 * std::hypot(b.noise, b.reference_noise) / 16 + 0.05);
    }
  }
  for (const ChartPoint& p : s.points) {
    EXPECT_GT(p.run_s, 0) << p.id;
    for (const ChartChannel& c : p.channels) {
      EXPECT_LE(c.error.mean, 1.000001 * c.error.rms) << p.id;  // flat: pixels may be off alike
      EXPECT_LE(c.error.rms, 1.000001 * c.error.largest) << p.id;
      EXPECT_LE(c.error.percentile95, c.error.largest) << p.id;
    }
  }
  ASSERT_EQ(s.choices.size(), 2u);
  for (const ChartChoice& c : s.choices) EXPECT_TRUE(c.met) << c.accuracy;
  for (const char* name : {"chart.csv", "chart.json", "chart.svg", "chart.png", "reference/1.exr"})
    EXPECT_GT(fs::file_size(folder.path() / name), 100u) << name;
}

TEST(ChartJob, TheSameJobGoesOnToTheSameFigures) {
  const TemporaryFolder folder;
  ChartJob job = small_chart(folder.path() / "whole", 8);
  job.families = {"default", "direct", "replay", "accuracy"};
  run(job);
  const auto whole = figures(job.folder / "chart.csv");

  job.folder = folder.path() / "stopped";
  job.threads = 1;
  CancelToken cancel;
  Reporter listener;
  int seen = 0;
  const PointCallback tell = [&](const ChartPoint&) {
    if (++seen == 3) cancel.cancel();
  };
  listener.cancel = &cancel;
  const ChartSummary first = run(job, listener, tell);
  EXPECT_FALSE(first.complete);
  EXPECT_FALSE(fs::exists(job.folder / "chart.csv"));
  double last = 0;
  Reporter again;
  again.on_progress = [&](double done, double total, std::string_view) {
    EXPECT_GE(done, last - 1e-9);
    EXPECT_LE(done, total + 1e-9);
    last = done;
  };
  const ChartSummary second = run(job, again);
  EXPECT_TRUE(second.complete);
  EXPECT_EQ(second.found, 3);
  EXPECT_EQ(figures(job.folder / "chart.csv"), whole);

  job.seed = 2;  // another job's points do not count
  EXPECT_EQ(run(job).found, 0);
  EXPECT_NE(figures(job.folder / "chart.csv"), whole);
}

TEST(ChartJob, LeavesOutDetailOfHeightFieldsAndSaysWhatCannotBeHad) {
  const TemporaryFolder folder;
  ChartJob job = small_chart(folder.path(), 6);
  job.scene.specimen.substrate.reset();
  job.scene.specimen.height_field =
      mc::HeightFieldBody{"rough", make_rough({60, 60, 2}, 2, 10, 1), 0, Edge::mirror};
  job.scene.beam.tilt_deg = 30;
  job.families = {"mesh-tolerance", "secant"};
  const ChartSummary s = run(job);
  ASSERT_EQ(s.points.size(), 1u);
  EXPECT_EQ(s.points[0].id, "mesh-tolerance-1nm");
  EXPECT_THAT(s.left_out, testing::ElementsAre(HasSubstr("straight above")));
}

TEST(ChartJob, SaysWhatIsWrongBeforeAnyWork) {
  const TemporaryFolder folder;
  const ChartJob good = small_chart(folder.path() / "chart");
  const auto refused = [&](const char* subject, const auto& change) {
    ChartJob job = good;
    change(job);
    try {
      run(job);
      ADD_FAILURE() << subject;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(subject));
    }
  };
  refused("chart.accuracy", [](ChartJob& j) { j.finest = 0.5; });
  refused("chart.reference", [](ChartJob& j) { j.reference_accuracy = 0.9 * 0.03; });
  refused("chart.compared", [](ChartJob& j) { j.compared_pixels = 3; });
  refused("chart.most", [](ChartJob& j) { j.most_primaries = 10; });
  refused("'fast' is none of them. Choose of default, direct",
          [](ChartJob& j) { j.families = {"fast"}; });
  refused("`output`", [](ChartJob& j) { j.folder.clear(); });
  refused("current", [](ChartJob& j) { j.scene.budget = mc::dose_of_probe(100, 1); });
  EXPECT_FALSE(fs::exists(good.folder));
}

TEST(Pareto, IsWhatNothingBeats) {
  const std::vector<Trade> trades{{3, 1}, {1, 3},   {2, 3},   {2, 2}, {1, 4},
                                  {4, 1}, {NAN, 0}, {5, 0.5}, {1, 3}};
  EXPECT_EQ(pareto_front(trades), (std::vector<std::size_t>{1, 3, 0, 7}));
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(ComparedPixels, LieAboutTheMiddleOfTheScan) {
  for (const auto& [width, height] :
       {std::pair{160, 160}, {64, 64}, {33, 90}, {7, 3}, {1, 1}, {1000, 2}}) {
    mc::Scan scan;
    scan.width = width;
    scan.height = height;
    scan.pixel_x_nm = 2;
    scan.pixel_y_nm = 3;
    scan.center_x_nm = 10;
    for (const int about : {16, 100, 1000000}) {
      const ComparedPixels p = choose_pixels(scan, about);
      EXPECT_LE(p.first_x + (p.width - 1) * p.step, width - 1);
      EXPECT_EQ(p.first_x, width - 1 - (p.first_x + (p.width - 1) * p.step));
      EXPECT_EQ(p.first_y, height - 1 - (p.first_y + (p.height - 1) * p.step));
      // The request scans the very same places.
      const mc::Scan few = resolve_scan(request_for(p, scan), {{-1, -1, 0}, {1, 1, 1}}, {});
      EXPECT_EQ(few.width, p.width);
      const double first = few.center_x_nm + (0.5 - 0.5 * few.width) * few.pixel_x_nm;
      EXPECT_NEAR(first, scan.center_x_nm + (p.first_x + 0.5 - 0.5 * width) * scan.pixel_x_nm,
                  1e-9);
    }
  }
}

TEST(ChartFiles, PointsAreReadBackForTheirJobAlone) {
  const TemporaryFolder folder;
  ChartPoint p{"replay-10", "replay", "10 electrons per pixel", 0.5, 0.25, 1e6, 1000, true, {}, {}};
  p.channels.push_back({"SE", {256, 0.5, 0.1, 0.2, 0.3, 0.4, -0.01, 0.15, 0.02, 0.05}});
  p.targets.push_back({0.1, 0.9, 0.01, true});
  write_point(folder.path() / "p.json", p, "job");
  const auto back = read_point(folder.path() / "p.json", "job");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->setting, p.setting);
  EXPECT_EQ(back->total_s(), 0.75);
  EXPECT_EQ(back->channels[0].error.bias, -0.01);
  EXPECT_TRUE(back->targets[0].met);
  EXPECT_FALSE(read_point(folder.path() / "p.json", "other"));
  EXPECT_FALSE(read_point(folder.path() / "none.json", "job"));
  io::write_text(folder.path() / "p.json", "{\"job\": \"job\"");
  EXPECT_FALSE(read_point(folder.path() / "p.json", "job"));
}

}  // namespace
}  // namespace surf::workflow
