// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/workflow/simulate_job.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;

std::string refusal(const SimulateJob& job) {
  try {
    run(job);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

SimulateJob job_in(const TemporaryFolder& folder, const std::string& name) {
  SimulateJob job = small_job();
  job.outputs = {folder.path() / name / "image.exr"};
  return job;
}

TEST(Extras, AreTheSameBytesForAnyThreadsAndTiles) {
  const TemporaryFolder folder;
  std::map<std::string, std::string> first;
  for (const auto& [threads, tile] : {std::pair{1, 1024}, {3, 5}}) {
    SimulateJob job = job_in(folder, std::to_string(threads));
    job.execution.threads = threads;
    job.execution.tile_pixels = tile;
    job.spectra = true;
    job.scene.detectors = mc::parse_detectors("quadrants", "test");
    job.extras = {{"z_nm", "material"}, 6, 3, {}};
    const SimulateSummary summary = run(job);
    EXPECT_EQ(summary.written.size(), 6u);
    for (const auto& path : summary.written) {
      const std::string name = path.filename().string();
      if (name.ends_with(".run.json")) continue;
      const std::string bytes = bytes_of(path);
      EXPECT_FALSE(bytes.empty()) << name;
      const auto known = first.emplace(name, bytes).first;
      EXPECT_TRUE(known->second == bytes) << name;
    }
  }
  EXPECT_EQ(first.size(), 5u);
}

TEST(Extras, SpectraAddUpToYields) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.spectra = true;
  job.scene.detectors = mc::parse_detectors("side:efficiency=0.5", "test");
  const SimulateSummary summary = run(job);
  std::map<std::string, double> sums;  // of each detector and quantity
  std::istringstream text(bytes_of(folder.path() / "a" / "image.spectra.csv"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "detector,quantity,unit,from,to,yield,standard_error");
  while (std::getline(text, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 7u);
    EXPECT_LT(std::stod(cells[3]), std::stod(cells[4]));
    sums[cells[0] + " " + cells[1]] += std::stod(cells[5]);
  }
  EXPECT_EQ(sums.size(), 9u);
  const mc::Balance& b = summary.result.balance;
  EXPECT_NEAR(sums["SE energy"], double(b.se) / double(b.incident), 1e-9);
  EXPECT_NEAR(sums["SE polar"], sums["SE energy"], 1e-9);
  EXPECT_NEAR(sums["BSE azimuth"], double(b.bse) / double(b.incident), 1e-9);
  EXPECT_LT(sums["SE-side polar"], 0.5 * sums["SE polar"]);
  EXPECT_GT(sums["SE-side polar"], 0.1 * sums["SE polar"]);
}

TEST(Extras, AnImageThatIsKeptIsWhatTheFileHolds) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "kept");
  job.extras.channels = {"z_nm", "electrons"};
  job.keep_image = true;
  const SimulateSummary summary = run(job);
  const Image file = io::read_image(job.outputs[0]);
  ASSERT_EQ(summary.image.channels.size(), file.channels.size());
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    EXPECT_EQ(summary.image.channels[c].name, file.channels[c].name);
    EXPECT_EQ(summary.image.channels[c].values, file.channels[c].values);
  }
  job.keep_image = false;
  EXPECT_TRUE(run(job).image.channels.empty());
}

TEST(Extras, ADoseReplacesTheNumberOfElectrons) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.scene.budget = mc::dose_of_probe(10, 0.5);
  const SimulateSummary summary = run(job);
  const Image image = io::read_image(job.outputs[0]);
  ASSERT_NE(image.find("SE.shot"), nullptr);
  EXPECT_TRUE(image.metadata.contains("simulation.dose"));
  EXPECT_FALSE(image.metadata.contains("simulation.electrons"));
  const double pixels = double(image.width()) * image.height();
  EXPECT_NEAR(double(summary.result.balance.incident) / pixels, 31.2, 5 * std::sqrt(31.2 / pixels));

  mc::BudgetWords words{.electrons = 5, .current_pa = 10, .dwell_us = 0.5};
  const auto said = [&]() -> std::string {
    try {
      mc::budget_of(words);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(said(), HasSubstr("simulation.electrons"));
  words = {.current_pa = 10};
  EXPECT_THAT(said(), HasSubstr("give both"));
  job.scene.budget = mc::dose_of_probe(10, -1);
  EXPECT_THAT(refusal(job), HasSubstr("above 0us"));
}

TEST(Extras, RefuseWhatCannotBe) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.extras.channels = {"slope"};
  EXPECT_THAT(refusal(job), HasSubstr("z_nm, normal, material"));
  job.extras = {{}, 5000, 0, {}};
  EXPECT_THAT(refusal(job), HasSubstr("output.deposit"));
  job.extras = {{}, 0, -1, {}};
  EXPECT_THAT(refusal(job), HasSubstr("output.trajectories"));
  job.extras = {{}, 0, 0, std::pair{0.0, 0.0}};
  EXPECT_THAT(refusal(job), HasSubstr("no trajectories"));
  job.extras = {{}, 0, 5, std::pair{1e6, 0.0}};
  EXPECT_THAT(refusal(job), HasSubstr("outside the scan"));
  job.extras = {};
  job.scene.detectors = mc::default_detectors();
  EXPECT_THAT(refusal(job), HasSubstr("given twice"));
  EXPECT_FALSE(std::filesystem::exists(job.outputs[0]));
}

TEST(Extras, OfThisJobReplaceTheirOwnKindOnly) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.spectra = true;
  job.scene.budget = mc::ElectronsPerPixel{1};
  job.extras.trajectories = 1;
  run(job);
  EXPECT_EQ(refusal(job), "no error") << "the same job again";
  const std::filesystem::path picture = folder.path() / "a" / "image.tracks.png";
  std::filesystem::remove(folder.path() / "a" / "image.run.json");  // which names it
  EXPECT_THAT(refusal(job),
              testing::AllOf(HasSubstr(picture.string()), HasSubstr("did not write")));
  std::filesystem::remove(picture);
  std::ofstream(folder.path() / "a" / "image.spectra.csv") << "wavelength,counts\n";
  EXPECT_THAT(refusal(job), HasSubstr("image.spectra.csv"));
}

TEST(Extras, DoNotReplaceInputs) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, ".");
  const std::filesystem::path input = folder.path() / "mesh.stl", output = job.outputs[0];
  std::ofstream(input) << "a mesh";
  job.scene.inputs = {input};
  std::filesystem::create_hard_link(input, output);
  EXPECT_THAT(refusal(job), testing::AllOf(HasSubstr("`output`"), HasSubstr("mesh.stl, an input")));
  std::filesystem::remove(output);
  std::filesystem::create_symlink(input, folder.path() / "image.run.json");
  EXPECT_THAT(refusal(job), HasSubstr("image.run.json (which belongs to"));
  EXPECT_EQ(bytes_of(input), "a mesh");
}

TEST(Extras, TellOfUnitsThatWereOverridden) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.scene.budget = mc::ElectronsPerPixel{1};
  job.scene.unit_overrides = {{"cube.stl", 1000.0}};
  run(job);
  EXPECT_EQ(io::read_image(job.outputs[0]).metadata.at("unit_override.1"), "cube.stl, 1000 nm");
}

TEST(Warnings, AreToldAsTheyCome) {
  const TemporaryFolder folder;
  SimulateJob job = job_in(folder, "a");
  job.scene.budget = mc::ElectronsPerPixel{1};
  std::vector<std::string> told;
  bool before = true;
  run(job,
      {.on_progress = [&](double, double, std::string_view) { before = before && !told.empty(); },
       .on_warning = [&](const std::string& warning) { told.push_back(warning); }});
  EXPECT_THAT(told, Contains(HasSubstr("one electron per pixel")));
  EXPECT_TRUE(before) << "warnings come before the simulation";
}

}  // namespace
}  // namespace surf::workflow
