// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/chain_chart_job.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "chart/chain_chart_files.h"
#include "chart/chain_methods.h"
#include "chart/sample_truth.h"
#include "chart/thesis_points.h"
#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"
#include "surf/workflow/sample_job.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

namespace fs = std::filesystem;

class ChainChart : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    SampleJob job;
    job.name = "pads";
    job.folder = folder_->path() / "pads";
    job.width = 112;
    job.height = 80;
    job.electrons = 10;
    job.cascades = 2048;
    job.threads = 2;
    ASSERT_TRUE(run(job).complete);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static ChainChartJob small_job(const fs::path& folder) {
    ChainChartJob job;
    job.sample = folder_->path() / "pads";
    job.folder = folder;
    job.model = fs::path(SEMSURF_SAMPLES) / "si-1keV-10nm.json";
    job.quick = true;
    job.draws = 1;
    job.threads = 2;
    return job;
  }

  static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> ChainChart::folder_;

// The rows of a CSV without the columns that hold times or memory.
std::vector<std::vector<std::string>> figures(const fs::path& csv) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> measured;
  std::istringstream in(io::read_file(csv));
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> fields = io::split_csv_line(line);
    if (rows.empty())
      for (std::size_t i = 0; i < fields.size(); ++i)
        if (fields[i].ends_with("_s") || fields[i] == "peak_mb") measured.push_back(i);
    for (const std::size_t i : measured) fields.at(i) = "";
    rows.push_back(std::move(fields));
  }
  return rows;
}

TEST_F(ChainChart, ShowsEveryMethodInASaneOrder) {
  const TemporaryFolder folder;
  const ChainChartJob job = small_job(folder.path());
  const ChainChartSummary s = run(job);
  ASSERT_TRUE(s.complete);
  EXPECT_EQ(s.sample, "pads");
  EXPECT_THAT(s.left_out, testing::ElementsAre(HasSubstr("chain: in a quick chart")));
  std::map<std::string, const RegistrationPoint*> registrations;
  for (const RegistrationPoint& p : s.registrations) registrations[p.id] = &p;
  std::map<std::string, const ReconstructionPoint*> reconstructions;
  for (const ReconstructionPoint& p : s.reconstructions) reconstructions[p.family] = &p;
  std::set<std::string> families;
  for (const RegistrationPoint& p : s.registrations) families.insert(p.family);
  for (const ChainFamily& f : chain_chart_families())
    EXPECT_EQ(f.registers ? families.contains(f.name) : reconstructions.contains(f.name),
              f.name != "chain")
        << f.name;

  for (const RegistrationPoint& p : s.registrations) {
    EXPECT_EQ(p.draws, 1) << p.id;
    EXPECT_EQ(p.right + p.wrong, p.verified) << p.id;
    EXPECT_GT(p.median_s, 0) << p.id;
  }
  EXPECT_EQ(registrations.at("landmarks-only-0.1px")->right, 1);
  EXPECT_EQ(registrations.at("landmarks-only-16px")->wrong, 1);
  EXPECT_LT(registrations.at("landmarks-4px")->largest_px,
            1);  // refined, it is nearer than they are

  EXPECT_NEAR(reconstructions.at("erosion")->steps[0].rms_nm, s.eroded_nm, 1e-12);
  EXPECT_LT(reconstructions.at("gauss-newton")->steps.back().rms_nm, s.eroded_nm);
  EXPECT_GT(s.floor_nm, 0);
  EXPECT_LT(s.floor_nm, s.eroded_nm);
  for (const ReconstructionPoint& p : s.reconstructions) {
    double before = 0;
    for (const ReconstructionStep& step : p.steps) {
      EXPECT_GT(step.run_s, before) << p.id;
      before = step.run_s;
      EXPECT_TRUE(std::isfinite(step.rms_nm)) << p.id;
    }
  }
  for (const char* name :
       {"registration.csv", "registration.svg", "registration.png", "reconstruction.csv",
        "reconstruction.svg", "reconstruction.png", "chart.json"})
    EXPECT_GT(fs::file_size(folder.path() / name), 100u) << name;
  EXPECT_EQ(figures(folder.path() / "registration.csv").size(), 1 + s.registrations.size());
}

TEST_F(ChainChart, TheSameJobGoesOnToTheSameFigures) {
  const TemporaryFolder folder;
  ChainChartJob job = small_job(folder.path() / "whole");
  job.families = {"correlation", "landmarks-only", "erosion", "gauss-newton"};
  run(job);

  const auto same = [&](const fs::path& other) {
    for (const char* name : {"registration.csv", "reconstruction.csv"})
      EXPECT_EQ(figures(other / name), figures(folder.path() / "whole" / name)) << name;
  };
  job.folder = folder.path() / "stopped";
  job.threads = 1;
  CancelToken cancel;
  Reporter listener;
  int seen = 0;
  ChainChartCallbacks points;
  points.registration = [&](const RegistrationPoint&) {
    if (++seen == 3) cancel.cancel();
  };
  listener.cancel = &cancel;
  EXPECT_FALSE(run(job, listener, points).complete);
  EXPECT_FALSE(fs::exists(job.folder / "chart.json"));
  double last = 0;
  Reporter again;
  again.on_progress = [&](double done, double total, std::string_view) {
    EXPECT_GE(done, last - 1e-9);
    EXPECT_LE(done, total + 1e-9);
    last = done;
  };
  io::write_text(job.folder / "points" / "landmarks-only-4px.json", "{\"job\"");  // damaged
  const ChainChartSummary second = run(job, again);
  EXPECT_TRUE(second.complete);
  EXPECT_EQ(second.found, 3);
  same(job.folder);

  job.families = {"landmarks-only"};
  job.seed = 2;  // another job's points do not count
  const ChainChartSummary other = run(job);
  EXPECT_EQ(other.found, 0);
  EXPECT_TRUE(other.reconstructions.empty());
  EXPECT_NE(figures(job.folder / "registration.csv"),
            figures(folder.path() / "whole" / "registration.csv"));
}

TEST_F(ChainChart, DrawsAreAsFarOffAsTheySay) {
  const SampleTruth sample = read_sample(small_job("unused").sample);
  const Affine& truth = sample.sem.sem_to_afm;
  PlacedImage everywhere = sample.sem.image;  // whatever the map, it lies on this
  everywhere.origin_x_nm = everywhere.origin_y_nm = -1e5;
  everywhere.values = Grid<double>(2, 2);
  everywhere.pitch_x_nm = everywhere.pitch_y_nm = 2e5;
  double landmarks = 0;
  constexpr int draws = 200;
  for (int i = 0; i < draws; ++i) {
    const RegistrationDraw shifted = draw_registration(sample, 8, 0, 1, i),
                           turned = draw_registration(sample, 0, 5, 1, i);
    // In the scan's frame lengths are 1.01 to 1.035 of the SEM's.
    EXPECT_NEAR(registration_error_px(truth, shifted.start, shifted.sem, everywhere), 8, 0.3);
    EXPECT_EQ(shifted.sem.values.width(), 95);
    EXPECT_EQ(shifted.sem.values.height(), 68);
    const Affine off = compose(inverse(truth), turned.start);
    EXPECT_NEAR(std::abs(parts_of(off).rotation_rad), 5 * std::acos(-1.0) / 180, 1e-9);
    const Point2 middle = turned.sem.place_nm(47, 33.5), back = off(middle);
    EXPECT_NEAR(std::hypot(back.x - middle.x, back.y - middle.y), 0, 1e-6);
    for (const auto& [sem, afm] : shifted.pairs) {
      const Point2 p = truth(sem);
      landmarks += (p.x - afm.x) * (p.x - afm.x) + (p.y - afm.y) * (p.y - afm.y);
    }
    // Both are of one place.
    const Point2 first = shifted.sem.place_nm(0, 0);
    const int x = static_cast<int>(std::lround(first.x / 10)),
              y = static_cast<int>(std::lround(first.y / 10));
    EXPECT_EQ(shifted.sem.values(3, 5), sample.sem.image.values(x + 3, y + 5));
  }
  EXPECT_NEAR(std::sqrt(landmarks / (4 * draws)) / 10, 8, 0.6);
}

TEST_F(ChainChart, ReadsWhatIsTrueOfASample) {
  SampleTruth s = read_sample(small_job("unused").sample);
  const auto json = nlohmann::json::parse(s.json);
  EXPECT_EQ(s.name, "pads");
  EXPECT_NEAR(s.scan.z_nm(0, 0) - s.afm.image.z_nm(0, 0), json["afm"]["offset_nm"].get<double>(),
              1e-9);
  EXPECT_NEAR(
      (s.scan.z_nm(0, 30) - s.afm.image.z_nm(0, 30)) - (s.scan.z_nm(0, 0) - s.afm.image.z_nm(0, 0)),
      30 * 20 * std::tan(json["afm"]["tilt_y_deg"].get<double>() * std::acos(-1.0) / 180), 1e-9);
  EXPECT_EQ(s.sem.sem_to_afm.y0, json["sem_to_afm"][5].get<double>());
  EXPECT_EQ(s.energy_ev, 1000);
}

RegistrationPoint registered(const char* family, double px, double deg, int right) {
  RegistrationPoint p;
  p.family = family;
  p.offset_px = px;
  p.offset_deg = deg;
  p.draws = 10;
  p.right = right;
  p.median_s = px + deg;
  return p;
}

TEST(CaptureRange, EndsWhereSuccessDoes) {
  const std::vector<RegistrationPoint> points{registered("a", 4, 0, 9),  registered("a", 2, 0, 10),
                                              registered("a", 8, 0, 8),  registered("a", 16, 0, 10),
                                              registered("a", 0, 5, 10), registered("b", 2, 0, 8)};
  const CaptureRange a = capture_range(points, "a"), b = capture_range(points, "b");
  EXPECT_EQ(a.px, 4);
  EXPECT_FALSE(a.px_open);
  EXPECT_EQ(a.deg, 5);
  EXPECT_TRUE(a.deg_open);
  EXPECT_EQ(a.median_s, 5);
  EXPECT_FALSE(b.px || b.deg || b.px_open || b.deg_open);
}

TEST(ThesisPoints, AreTable10_1) {
  EXPECT_NEAR(thesis_points[2].ratio() * thesis_points[2].ratio(), 0.114, 5e-4);
  EXPECT_NEAR(thesis_points[6].ratio() * thesis_points[6].ratio(), 0.049, 5e-4);
  EXPECT_GT(thesis_points[1].ratio(), 1);  // it got worse, against the sharper tip's scan
}

TEST(ChainChartFiles, PointsAreReadBack) {
  ReconstructionPoint p;
  p.id = "gauss-newton";
  p.steps = {{5, 0.25, 3}, {1.4, 0.5, 1.25}};
  p.preparation_s = 1;
  ReconstructionPoint back;
  from_json(to_json(p), back);
  EXPECT_EQ(back.total_s(), 1.5);
  EXPECT_EQ(to_json(back), to_json(p));
  const RegistrationPoint r = registered("a", 4, 0, 9);
  RegistrationPoint again;
  from_json(to_json(r), again);
  EXPECT_EQ(to_json(again), to_json(r));
}

TEST_F(ChainChart, SaysWhatIsWrongBeforeAnyWork) {
  const TemporaryFolder folder;
  const ChainChartJob good = small_job(folder.path() / "chart");
  const auto refused = [&](const char* text, const auto& change) {
    ChainChartJob job = good;
    change(job);
    try {
      run(job);
      ADD_FAILURE() << text;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(text));
    }
  };
  refused("without truth.json", [&](ChainChartJob& j) { j.sample = folder.path(); });
  refused("semsurf sample", [&](ChainChartJob& j) { j.sample = folder.path(); });
  refused("chart.draws", [](ChainChartJob& j) { j.draws = -1; });
  refused("'replay' is none of those for samples. Choose of correlation",
          [](ChainChartJob& j) { j.families = {"replay"}; });
  refused("with `chart.quick` the chain is left out",
          [](ChainChartJob& j) { j.families = {"chain"}; });
  refused("no folder is given", [](ChainChartJob& j) { j.folder.clear(); });
  refused("sample's own folder", [](ChainChartJob& j) { j.folder = j.sample; });
  EXPECT_FALSE(fs::exists(good.folder));
  fs::copy(good.sample, folder.path() / "damaged");
  io::write_text(folder.path() / "damaged" / "truth.json", "{\"sample\": \"pads\"}");
  ChainChartJob job = good;
  job.sample = folder.path() / "damaged";
  EXPECT_THROW(run(job), FileError);
  EXPECT_FALSE(fs::exists(good.folder));
}

}  // namespace
}  // namespace surf::workflow
