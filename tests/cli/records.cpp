// SPDX-License-Identifier: GPL-3.0-or-later
// Every parameter of a simulation that changes its files is found in them: each option is given
// another value than its default, and the image is read again.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "bound_parameters.h"
#include "in_process.h"
#include "surf/core/random.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/shapes.h"
#include "surf/workflow/simulate_job.h"
#include "temporary_folder.h"

namespace surf {
namespace {

/// What is given, besides the usual, and what the image then says under the parameter's key. Empty:
/// the parameter's text.
struct Change {
  std::vector<std::string> options;
  std::string key, value;
};

const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> all{
      {"beam.energy", {{"--energy", "2keV"}, "beam.energy_ev", "2000"}},
      {"beam.tilt", {{"--tilt", "30deg"}, "beam.tilt_deg", "30"}},
      {"beam.azimuth", {{"--azimuth", "45"}, "beam.azimuth_deg", "45"}},
      {"beam.spot", {{"--spot", "2nm"}, "beam.spot_nm", "2"}},
      {"beam.convergence", {{"--convergence", "1deg"}, "beam.convergence_deg", "1"}},
      {"beam.focus", {{"--focus", "0.1um"}, "beam.focus_nm", "100"}},
      {"beam.working_distance",
       {{"--working-distance", "5mm"}, "beam.working_distance_nm", "5e+06"}},
      {"beam.current", {{"--current", "20pA", "--dwell", "0.1us"}, "beam.current_pa", "20"}},
      {"beam.dwell", {{"--current", "20pA", "--dwell", "0.1us"}, "beam.dwell_us", "0.1"}},
      {"scan.size", {{"--size", "6x5"}, "scan.height", "5"}},
      {"scan.pixel_size", {{"--pixel-size", "10nmx20nm"}, "scan.pixel_y_nm", "20"}},
      {"scan.region", {{"--region", "-20,-20,0,0", "--size", "4x4"}, "scan.center_x_nm", "-10"}},
      {"simulation.electrons", {{"--electrons", "3"}, "simulation.electrons", "3"}},
      {"simulation.accuracy", {{"--accuracy", "60%"}, "simulation.accuracy", "0.6"}},
      {"simulation.accuracy_floor",
       {{"--accuracy", "60%", "--accuracy-floor", "0.5"}, "simulation.accuracy_floor", "0.5"}},
      {"simulation.method", {{"--method", "replay"}, "simulation.method", "replay"}},
      {"simulation.mesh_tolerance",
       {{"--mesh-tolerance", "0.5nm"}, "simulation.mesh_tolerance_nm", "0.5"}},
      {"simulation.detectors", {{"--detector", "SE1:name=first"}, "detector.3", "first:"}},
      {"simulation.physics", {{"--physics", "barrier=off"}, "simulation.physics", "barrier=off"}},
      {"simulation.cutoff", {{"--cutoff", "20"}, "simulation.cutoff_ev", "20"}},
      {"simulation.seed", {{"--seed", "5"}, "simulation.seed", "5"}},
      {"simulation.estimate",
       {{"--electrons", "8", "--estimate", "guided"}, "simulation.estimate", "guided"}},
      {"simulation.guide_model", {{"--guide-model", "off"}, "simulation.guide_model", "off"}},
      {"output.channels", {{"--channels", "z_nm,electrons"}, "output.channels", "z_nm,electrons"}},
      {"output.deposit", {{"--deposit", "4"}, "output.deposit", "4"}},
      {"output.trajectories", {{"--trajectories", "2"}, "output.trajectories", "2"}},
      {"output.trajectories_at",
       {{"--trajectories", "2", "--trajectories-at", "5,5"}, "output.trajectories_at_nm", "5,5"}},
      {"output.png_channel", {{"--png-channel", "BSE"}, "output.png_channel", "BSE"}},
      {"output.layout", {{"--layout", "tiles"}, "output.layout", "tiles"}},
      {"specimen.material", {{"--material", "Au"}, "material.1.name", "Au"}},
      {"specimen.unit", {{"--unit", "um", "--override-unit"}, "specimen.body.1", "20000"}},
      {"specimen.override_unit",
       {{"--unit", "um", "--override-unit"}, "unit_override.1", "1000 nm"}},
      {"specimen.substrate", {{"--substrate", "C"}, "specimen.substrate", "C, top at 0 nm"}},
      {"specimen.substrate_z",
       {{"--substrate", "C", "--substrate-z", "-3nm"}, "specimen.substrate", "C, top at -3 nm"}},
  };
  return all;
}

/// Recorded by what they read, or of height fields (below).
const std::set<std::string> others{"specimen.edge", "scan.height_pitch", "scan.height_unit",
                                   "scan.height_channel"};

class Records : public testing::Test {
 protected:
  Records() { io::write_mesh(mesh_, make_box({-20, -20, 0}, {20, 20, 40})); }

  std::map<std::string, std::string> made_with(const std::vector<std::string>& options) {
    const std::string output = (folder_.path() / "image.tif").string();
    std::vector<std::string> words{"simulate",     mesh_.string(), "-q", "--cache", "off",
                                   "--checkpoint", "off",          "-o", output};
    const auto given = [&](const char* name) {
      return std::ranges::find(options, name) != options.end();
    };
    if (!given("--size") && !given("--pixel-size")) words.insert(words.end(), {"--size", "4x4"});
    if (!given("--electrons") && !given("--accuracy") && !given("--current"))
      words.insert(words.end(), {"--electrons", "2"});
    words.insert(words.end(), options.begin(), options.end());
    const test::Said said = test::semsurf(words);
    EXPECT_EQ(said.code == 4 ? 0 : said.code, 0) << said.err;  // 4: an accuracy was missed
    return said.code == 0 || said.code == 4 ? io::read_image(output).metadata
                                            : std::map<std::string, std::string>();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path mesh_ = folder_.path() / "cube.stl";
};

TEST_F(Records, HoldEveryParameterOfASimulation) {
  const auto plain = made_with({});
  std::set<std::string> known = others;
  for (const auto& [name, change] : changes()) {
    SCOPED_TRACE(name);
    known.insert(name);
    const auto made = made_with(change.options);
    ASSERT_TRUE(made.contains(change.key));
    EXPECT_THAT(made.at(change.key), testing::HasSubstr(change.value));
    if (plain.contains(change.key)) {
      EXPECT_NE(plain.at(change.key), made.at(change.key)) << "it is so by default";
    }
  }
  // A new parameter has to be looked for, too.
  const auto look = [&](const Parameter& about, Field&) {
    if (about.recorded) {
      EXPECT_TRUE(known.contains(about.name)) << about.name;
    }
  };
  workflow::SimulateJob job;
  for_each_parameter(job, look);
  io::SpecimenRequest specimen;
  for_each_parameter(specimen, look);
}

TEST_F(Records, HoldHowAHeightFieldWasRead) {
  const std::filesystem::path field = folder_.path() / "field.txt";
  io::write_height_field(field, make_mesa({30, 30, 2}, 5, 10, 2), {});
  mesh_ = field;
  const auto of = [&](const std::vector<std::string>& options) {
    return made_with(options).at("specimen.height_field");
  };
  EXPECT_THAT(of({"--edge", "flat"}), testing::HasSubstr("edge flat"));
  EXPECT_THAT(of({"--height-pitch", "3nm"}), testing::HasSubstr("pitch 3 x 3 nm"));
}

/// What is written besides images and surfaces: each option in turn, and the line that the file
/// then has.
struct Written {
  std::string name;
  std::vector<std::string> words;  // `FILE` is what is written
  std::string extension;
  std::vector<std::pair<std::vector<std::string>, std::string>> changes;  // options, "key = value"
};

const std::vector<Written>& all_written() {
  static const std::vector<Written> all{
      {"noise_scan",
       {"noise", "scan", "scan.txt", "--plot", "FILE"},
       ".svg",
       {{{"--flat"}, "noise.flat = on"},
        {{"--flat", "--degree", "1"}, "noise.degree = 1"},
        {{"--flat", "--lags", "7"}, "noise.lags = 7"},
        {{"--flat", "--height-pitch", "3nm"}, "scan.height_pitch_nm = 3"}}},
      {"noise_sem",
       {"noise", "sem", "image.tif", "--plot", "FILE"},
       ".svg",
       {{{"--block", "9"}, "noise.block = 9"},
        {{"--black", "-99"}, "noise.black = -99"},
        {{"--white", "999"}, "noise.white = 999"},
        {{"--flat-region", "1,1,30,30", "--flat-region", "31,1,60,30", "--flat-region",
          "1,31,30,60"},
         "noise.flat_region = 1,1,30,30 31,1,60,30 1,31,30,60"}}},
      {"noise_counts",
       {"noise", "counts", "scene.toml", "--trials", "200", "--electrons", "3", "--csv", "FILE"},
       ".csv",
       {{{"--at", "5,-5"}, "counts.at_nm = 5,-5"},
        {{"--seed", "9"}, "counts.seed = 9"},
        {{}, "counts.trials = 200"},
        {{}, "counts.electrons = 3"},
        {{}, "beam.energy_ev = 700"}}},
      {"substrate",
       {"level", "scan.txt", "--substrate-mask", "FILE", "-o", "flat.txt"},
       ".tif",
       {{{"--level-tolerance", "0.7nm"}, "level.tolerance_nm = 0.7"},
        {{"--rows", "median"}, "level.rows = median"}}},
      {"tip",
       {"tip", "--shape", "cone:5nm,20deg", "--pixel-size", "2nm", "-o", "tip.gsf", "--plot",
        "FILE"},
       ".svg",
       {{{"--tip-size", "9"}, "tip.size = 9"}}},
      {"library",
       {"library", "plot", "Si", "--energy", "500eV", "--tilt", "0", "-o", "FILE"},
       ".svg",
       {{{"--seed", "9"}, "simulation.seed = 9"},
        {{}, "library.materials = Si"},
        {{}, "library.tilt_deg = 0"},
        {{"--physics", "barrier=off"}, "secondaries=on,barrier=off"},
        {{"--cascades", "12288"}, "library.cascades = 12288"}}},
  };
  return all;
}

class WrittenRecords : public testing::TestWithParam<Written> {
 protected:
  WrittenRecords() {
    HeightField scan;
    scan.z_nm = Grid<double>(64, 64);
    scan.pitch_x_nm = scan.pitch_y_nm = 2;
    Image image;
    image.pitch_x_nm = image.pitch_y_nm = 1;
    image.channels = {{"SE", "1", Grid<float>(64, 64)}};
    RandomStream random(1, 2, 3);
    for (std::size_t i = 0; i < scan.z_nm.size(); ++i) {
      scan.z_nm.data()[i] = random.uniform();
      image.channels[0].values.data()[i] =
          static_cast<float>(100 * (1 + i / 2048) + 10 * random.uniform());
    }
    io::write_height_field(folder_.path() / "scan.txt", scan, {});
    io::write_image(folder_.path() / "image.tif", image);
    std::ofstream(folder_.path() / "scene.toml")
        << "[substrate]\nmaterial = \"Si\"\n[beam]\nenergy = 700\n"
           "[scan]\nsize = \"4x4\"\npixel_size = 10\n";
  }
  test::TemporaryFolder folder_;
};

TEST_P(WrittenRecords, HoldEveryParameter) {
  for (const auto& [options, line] : GetParam().changes) {
    SCOPED_TRACE(line);
    const std::string file = (folder_.path() / ("out" + GetParam().extension)).string();
    std::vector<std::string> words = GetParam().words;
    for (std::string& word : words)
      if (word == "FILE") word = file;
      else if (std::filesystem::exists(folder_.path() / word) || word.ends_with(".gsf") ||
               word == "flat.txt")
        word = (folder_.path() / word).string();
    words.push_back("-q");
    words.insert(words.end(), options.begin(), options.end());
    const test::Said said = test::semsurf(words);
    if (said.err.find("plots are drawn by Python 3 with Matplotlib") != std::string::npos)
      GTEST_SKIP() << said.err;
    ASSERT_TRUE(said.code == 0 || said.code == 4) << said.err;
    std::string text;
    if (GetParam().extension == ".tif") {
      for (const auto& [key, value] : io::read_image(file).metadata)
        text += key + " = " + value + "\n";
    } else {
      std::ifstream in(file);
      text.assign(std::istreambuf_iterator<char>(in), {});
    }
    EXPECT_NE(text.find(line), std::string::npos) << text.substr(0, 3000);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, WrittenRecords, testing::ValuesIn(all_written()),
                         [](const auto& about) { return about.param.name; });

}  // namespace
}  // namespace surf
