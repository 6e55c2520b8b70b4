// SPDX-License-Identifier: GPL-3.0-or-later
// Help texts say in parentheses what holds where an option is not given. Whatever they say with a number is compared
// here with the structs that decide it. A new option with such a number has to be entered below.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <charconv>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <variant>

#include "bound_parameters.h"
#include "in_process.h"
#include "mesh_parameters.h"
#include "surf/afm/blind_tip.h"
#include "surf/afm/certainty.h"
#include "surf/afm/characterizer.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip_sweep.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/io/surface_file.h"
#include "surf/mc/beam.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/reconstruction/reconstruct.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/workflow/afm_preparation.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/chart_job.h"
#include "surf/workflow/count_job.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/sample_job.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/slope_table.h"
#include "surf/workflow/train_job.h"
#include "view_inputs.h"

namespace surf {
namespace {

/// An option of a command, and what its help says in parentheses with a number in it.
struct Stated {
  std::string command, option, text;
};

std::vector<std::string> commands_of(const std::vector<std::string>& parent) {
  std::vector<std::string> words = parent, names;
  words.push_back("--help");
  std::istringstream help(test::semsurf(words).out);
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    static const std::set<std::string> headings{"Commands:", "SEM:", "AFM:", "AFM + SEM:", "Surfaces and files:",
                                                "Set-up and study:"};
    if (!line.empty() && line[0] != ' ') listed = headings.contains(line);
    else if (listed && line.size() > 2 && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

/// Descriptions run over several lines, which are indented.
std::vector<std::pair<std::string, std::string>> options_of(const std::vector<std::string>& command) {
  std::vector<std::string> words = command;
  words.push_back("--help");
  const test::Said said = test::semsurf(words);
  EXPECT_EQ(said.code, 0) << said.err;
  std::vector<std::pair<std::string, std::string>> options;
  std::istringstream help(said.out);
  bool within = false;
  for (std::string line; std::getline(help, line);) {
    static const std::regex begins(R"(^  (?:-\w,)?(--[\w-]+).*)"), goes_on(R"(^ {20,}(\S.*)$)");
    std::smatch found;
    if (std::regex_match(line, found, begins)) options.emplace_back(found[1], line);
    else if (within && std::regex_match(line, found, goes_on)) options.back().second += " " + found[1].str();
    else {
      within = false;
      continue;
    }
    within = true;
  }
  return options;
}

std::vector<Stated> stated_by(const std::vector<std::string>& command) {
  std::vector<Stated> out;
  for (const auto& [option, text] : options_of(command)) {
    static const std::regex in_parentheses(R"(\(([^()]*\d[^()]*)\))");
    std::string all;
    for (std::sregex_iterator it(text.begin(), text.end(), in_parentheses), end; it != end; ++it)
      all += (all.empty() ? "" : " | ") + (*it)[1].str();
    if (!all.empty()) out.push_back({fmt::format("{}", fmt::join(command, " ")), option, all});
  }
  return out;
}

std::vector<Stated> everything_stated() {
  std::vector<Stated> out;
  for (const std::string& command : commands_of({})) {
    const std::vector<std::string> actions = commands_of({command});
    for (Stated& s : stated_by({command})) out.push_back(std::move(s));
    for (const std::string& action : actions)
      for (Stated& s : stated_by({command, action})) out.push_back(std::move(s));
  }
  return out;
}

/// The number in front, in nm, eV or degrees; "3%" is 0.03.
double value_of(const std::string& text) {
  static const std::map<std::string, double> units{{"", 1}, {"nm", 1}, {"um", 1e3}, {"eV", 1}, {"keV", 1e3},
                                                   {"deg", 1}, {"%", 0.01}, {"s", 1}};
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(error, std::errc{}) << text;
  std::string unit(rest, text.data() + text.size());
  unit.resize(std::min(unit.find_first_of(" ;,:|"), unit.size()));
  EXPECT_TRUE(units.contains(unit)) << text;
  return units.contains(unit) ? value * units.at(unit) : 0;
}

/// A number stands at the front of what is said; a text is all of it.
using Expected = std::variant<double, std::string>;

struct Default {
  std::vector<std::string> commands;
  const char* option;
  Expected expected;
};

std::vector<Default> defaults() {
  const mc::Beam beam;
  const mc::SimulationOptions simulation;
  const workflow::ChartJob chart;
  const workflow::TrainJob train;
  const FacetNetworkFitOptions network;
  const ReconstructionOptions reconstruction;
  const workflow::AfmPreparationOptions preparation;
  const workflow::SampleJob sample;
  const workflow::CountJob counts;
  const RepairOptions repair;
  const io::Magnification magnification;
  const std::vector<std::string> morphologies{"erode", "dilate", "open", "close"}, chains{"register", "reconstruct"};
  const std::vector<std::string> libraries{"library build", "library plot"};
  return {
      {{"chart"}, "--accuracy", chart.finest},
      {{"chart"}, "--compared", double(chart.compared_pixels)},
      {{"chart"}, "--most", chart.most_primaries},
      {{"chart"}, "--surfaces", double(chart.surfaces)},
      {{"chart"}, "--surface-size", double(chart.surface_px)},
      {{"chart"}, "--seed", double(chart.seed)},
      {{"level"}, "--level-degree", double(preparation.level.degree)},
      {{"noise scan"}, "--degree", double(FlatNoiseOptions{}.degree)},
      {{"noise counts"}, "--electrons", fmt::format("{}", fmt::join(counts.electrons, ","))},
      {{"noise counts"}, "--trials", double(counts.trials)},
      {{"noise counts"}, "--seed", fmt::format("the scene's, or {}", counts.seed)},
      {{"mesh"}, "--scale", cli::MeshParameters{}.scale},
      {{"mesh"}, "--sliver", repair.sliver_nm},
      {{"mesh"}, "--min-component", repair.min_component_nm},
      {{"mesh"}, "--magnification", magnification.factor},
      {{"mesh"}, "--z-exaggeration", magnification.z_exaggeration},
      {morphologies, "--upsample", double(MorphologyOptions{}.upsample)},
      {{"erode", "dilate"}, "--distance", workflow::MorphologyParameters{}.distance_nm},
      {{"noise scan"}, "--lags", double(NoiseCheckOptions{}.lags)},
      {{"certainty"}, "--sigmas", CertaintyOptions{}.sigmas},
      {{"certainty"}, "--distance", CertaintyOptions{}.distance_nm},
      {{"train"}, "--surface-size", double(train.surface_px)},
      {{"train"}, "--hold-out", double(train.held_out)},
      {{"train"}, "--hidden", fmt::format("{}", fmt::join(network.hidden, ","))},
      {{"train"}, "--iterations", double(network.iterations)},
      {{"train"}, "--decay", network.decay},
      {{"train"}, "--model-error", network.tolerance},
      {{"train"},
       "--table-electrons",
       fmt::format("{} at each, 10240 in all", workflow::SlopeTableOptions{}.electrons)},
      {{"tip"}, "--tip-size", double(BlindTipOptions{}.width)},
      {{"tip"}, "--search", double(CharacterizerOptions{}.search)},
      {{"tip"}, "--apex-tolerance", BlindTipOptions{}.apex_tolerance_nm},
      {{"tip"}, "--layer", BlindTipOptions{}.layer_nm},
      {{"tip"}, "--sweep", fmt::format("0.3 to 8 standard deviations of the noise, {}", TipSweepOptions{}.thresholds)},
      {{"tip"}, "--seed", double(TipSweepOptions{}.seed)},
      {chains, "--level-degree", double(preparation.level.degree)},
      {chains, "--spot", workflow::ModelRequest{}.spot_nm},
      {{"register"}, "--seed", double(preparation.seed)},
      {{"reconstruct"}, "--upsample", double(workflow::ReconstructJob{}.upsample)},
      {{"reconstruct"}, "--probes", double(reconstruction.probes)},
      {{"reconstruct"}, "--seed", double(reconstruction.seed)},
      {{"sample"}, "--electrons", double(sample.electrons)},
      {{"sample"}, "--size", fmt::format("{}x{}", sample.width, sample.height)},
      {{"sample"}, "--seed", double(sample.seed)},
      {{"view"}, "--every", double(cli::ViewParameters{}.every)},
      {libraries, "--energy", beam.energy_ev},
      {libraries, "--seed", double(mc::CascadeSettings{}.seed)},
  };
}

/// Numbers that no struct holds: of files that do not say, of a choice made where it is used, and no defaults at all.
std::vector<Default> others() {
  const std::vector<std::string> scans{"level", "clean", "noise scan", "erode", "dilate", "open", "close",
                                       "certainty", "tip"};
  const std::vector<std::string> chains{"register", "reconstruct"}, libraries{"library build", "library plot"};
  return {
      {scans, "--height-pitch", "1 nm"},
      {chains, "--height-pitch", "1 nm"},
      {{"mesh", "view", "predict"}, "--height-pitch", "1 nm"},
      {{"chart"}, "--draws", "10, quickly 3"},
      {{"noise sem"}, "--block", "16, 12 or 8"},
      {{"mesh"}, "--stitch", "1e-6 of the diagonal"},
      {{"mesh"}, "--thickness", "5 % of the longer side"},
      {{"train"}, "--surfaces", "60; 0 if no images are needed"},
      {{"reconstruct"}, "--offset", "0"},
      {{"reconstruct"}, "--prior", "0.001, more on rough ground"},
      {{"library plot"}, "--tilt", "0; with one energy 0 to 75 degrees"},
      {{"simulate", "sweep"}, "--detector", "side:axis=60deg/90deg | loss:energy=900eV..,cone=30deg"},
      {libraries, "--accuracy", "2/accuracy"},
  };
}

const Default* find(const std::vector<Default>& all, const Stated& stated) {
  for (const Default& d : all)
    if (stated.option == d.option && std::ranges::count(d.commands, stated.command)) return &d;
  return nullptr;
}

/// Whether help is made from a description of the field, defaults and all.
bool is_described(const Stated& s) {
  static const std::set<std::string> names = [] {
    std::set<std::string> all;
    const auto add = [&](const Parameter& about, Field&) { all.insert(cli::option_name(about.name)); };
    workflow::SimulateJob job;
    for_each_parameter(job, add);
    io::SpecimenRequest specimen;
    for_each_parameter(specimen, add);
    return all;
  }();
  const bool of_scenes = s.command == "simulate" || s.command == "sweep" || s.command == "chart" ||
                         s.command == "train";
  static const std::set<std::string> of_chart{"--accuracy", "--seed"};   // others than those of simulations
  return of_scenes && names.contains(s.option) && !(s.command == "chart" && of_chart.contains(s.option));
}

TEST(HelpDefaults, AreThoseOfTheStructs) {
  const std::vector<Default> known = defaults(), fixed = others();
  std::set<std::pair<std::string, std::string>> seen;
  for (const Stated& s : everything_stated()) {
    SCOPED_TRACE(fmt::format("{} {} ({})", s.command, s.option, s.text));
    if (is_described(s)) continue;
    seen.emplace(s.command, s.option);
    const Default* found = find(known, s);
    if (!found) found = find(fixed, s);
    if (!found) {
      ADD_FAILURE() << "enter it in defaults(), with the field that holds it";
      continue;
    }
    if (const double* const number = std::get_if<double>(&found->expected)) EXPECT_DOUBLE_EQ(value_of(s.text), *number);
    else EXPECT_EQ(s.text, std::get<std::string>(found->expected));
  }
  // Nor may the list hold what is not said any more.
  for (const auto* list : {&known, &fixed})
    for (const Default& d : *list)
      for (const std::string& command : d.commands)
        EXPECT_TRUE(seen.contains({command, d.option})) << command << " " << d.option << " states no number";
}

TEST(HelpDefaults, EveryCommandIsLookedAt) {
  EXPECT_THAT(commands_of({}), testing::ElementsAre(
                                   "simulate", "sweep", "train", "predict",
                                   "level", "clean", "noise", "tip", "erode", "dilate", "open", "close", "certainty",
                                   "sample", "register", "calibrate", "reconstruct",
                                   "info", "view", "mesh", "materials",
                                   "library", "chart", "completion"));
  EXPECT_THAT(commands_of({"sweep"}), testing::ElementsAre("join"));
  EXPECT_THAT(commands_of({"library"}), testing::ElementsAre("list", "build", "plot", "remove"));
  const auto options = options_of({"reconstruct"});
  EXPECT_GT(options.size(), 30u);
}

}  // namespace
}  // namespace surf
