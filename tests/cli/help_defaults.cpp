// SPDX-License-Identifier: GPL-3.0-or-later
// Help says in parentheses what holds where an option is not given: the field's own default, or
// words in its place. Numbers in such words are compared here with the structs that decide them.
// New ones have to be entered below.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <charconv>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <variant>

#include "app.h"
#include "bound_parameters.h"
#include "in_process.h"
#include "surf/afm/blind_tip.h"
#include "surf/afm/tip_sweep.h"
#include "surf/io/surface_file.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/request/budget.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/fit_filter_bank.h"
#include "surf/workflow/count_job.h"
#include "surf/workflow/reconstruct_job.h"
#include "surf/workflow/register_job.h"
#include "surf/workflow/slope_table.h"
#include "surf/workflow/train_job.h"

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
    static const std::set<std::string> headings{
        "Commands:", "SEM:", "AFM:", "AFM + SEM:", "Surfaces and files:", "Set-up and study:"};
    if (!line.empty() && line[0] != ' ') listed = headings.contains(line);
    else if (listed && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

/// Descriptions run over several lines, which are indented.
std::vector<std::pair<std::string, std::string>> options_of(
    const std::vector<std::string>& command) {
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
    else if (within && std::regex_match(line, found, goes_on))
      options.back().second += " " + found[1].str();
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
  static const std::map<std::string, double> units{{"", 1},      {"nm", 1},  {"um", 1e3}, {"eV", 1},
                                                   {"keV", 1e3}, {"deg", 1}, {"%", 0.01}, {"s", 1}};
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
  const FacetNetworkFitOptions network;
  const io::Magnification magnification;
  const std::vector<std::string> chains{"register", "reconstruct"};
  return {
      {{"noise counts"}, "--seed", fmt::format("the scene's, or {}", workflow::CountJob{}.seed)},
      {{"simulate", "sweep", "chart"}, "--substrate-z", mc::Substrate{}.top_nm},
      {{"simulate", "sweep"}, "--electrons", double(mc::ElectronsPerPixel{}.count)},
      {{"simulate", "sweep"}, "--accuracy-floor", mc::Accuracy{}.floor},
      {{"train"}, "--electrons", double(mc::electrons_of(workflow::TrainJob{}.simulation.budget))},
      {{"train"}, "--least-eigenvalue", FilterBankFitOptions{}.eigenvalue_cutoff},
      {{"mesh"}, "--magnification", magnification.factor},
      {{"mesh"}, "--z-exaggeration", magnification.z_exaggeration},
      {{"train"}, "--hidden", fmt::format("{}", fmt::join(network.hidden, ","))},
      {{"train"}, "--iterations", double(network.iterations)},
      {{"train"}, "--decay", network.decay},
      {{"train"}, "--model-error", network.tolerance},
      {{"train"},
       "--table-electrons",
       fmt::format("{} at each, 10240 in all", workflow::SlopeTableOptions{}.electrons)},
      {{"tip"}, "--tip-size", double(BlindTipOptions{}.width)},
      {{"tip"},
       "--sweep",
       fmt::format("0.3 to 8 standard deviations of the noise, {}", TipSweepOptions{}.thresholds)},
      {{"register", "reconstruct", "compare"}, "--spot", workflow::ModelRequest{}.spot_nm},
  };
}

/// Numbers that no struct holds: of files that do not say, of a choice made where it is used, and
/// no defaults at all.
std::vector<Default> others() {
  const std::vector<std::string> scans{"level",  "clean",   "noise scan", "erode",
                                       "dilate", "open",    "close",      "certainty",
                                       "tip",    "compare", "survey"};
  const std::vector<std::string> chains{"register", "reconstruct"},
      libraries{"library build", "library plot"};
  return {
      {scans, "--height-pitch", "1 nm"},
      {chains, "--height-pitch", "1 nm"},
      {{"mesh", "view", "predict", "simulate", "sweep", "train", "chart"},
       "--height-pitch",
       "1 nm"},
      {{"compare"}, "--largest-window", "a quarter of the view, at most 64 samples"},
      {{"simulate"}, "--layout", "auto: tiles above 64 million pixels"},
      {{"chart"}, "--draws", "10, quickly 3"},
      {{"noise sem"}, "--block", "16, 12 or 8"},
      {{"mesh"}, "--stitch", "1e-6 of the diagonal"},
      {{"mesh"}, "--thickness", "5 % of the longer side"},
      {{"train"}, "--surfaces", "60; 0 if no images are needed"},
      {{"reconstruct"}, "--offset", "0"},
      {{"reconstruct"}, "--prior", "0.001, more on rough ground"},
      {{"library plot"}, "--tilt", "0; with one energy 0 to 75 degrees"},
      {libraries, "--accuracy", "2/accuracy | 10000 cascades"},
  };
}

const Default* find(const std::vector<Default>& all, const Stated& stated) {
  for (const Default& d : all)
    if (stated.option == d.option && std::ranges::count(d.commands, stated.command)) return &d;
  return nullptr;
}

/// Whether help is made from the field itself.
bool is_described(const Stated& s) {
  static cli::Action action;
  static const std::unique_ptr<CLI::App> app = cli::make_app(action, "");
  const CLI::App* command = app.get();
  std::istringstream words(s.command);
  for (std::string word; words >> word;) command = command->get_subcommand(word);
  return cli::shows_default(*command->get_option(s.option));
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
    if (const double* const number = std::get_if<double>(&found->expected))
      EXPECT_DOUBLE_EQ(value_of(s.text), *number);
    else EXPECT_EQ(s.text, std::get<std::string>(found->expected));
  }
  // Nor may the list hold what is not said any more.
  for (const auto* list : {&known, &fixed})
    for (const Default& d : *list)
      for (const std::string& command : d.commands)
        EXPECT_TRUE(seen.contains({command, d.option}))
            << command << " " << d.option << " states no number";
}

TEST(HelpDefaults, EveryCommandIsLookedAt) {
  EXPECT_THAT(commands_of({}),
              testing::ElementsAre("simulate", "sweep", "train", "predict", "estimate", "profile",
                                   "level", "clean", "noise", "tip", "erode", "dilate", "open",
                                   "close", "certainty", "survey", "sample", "register",
                                   "calibrate", "reconstruct", "refine", "compare", "info", "view",
                                   "mesh", "materials", "library", "chart", "completion"));
  EXPECT_THAT(commands_of({"sweep"}), testing::ElementsAre("join"));
  EXPECT_THAT(commands_of({"library"}), testing::ElementsAre("list", "build", "plot", "remove"));
  const auto options = options_of({"reconstruct"});
  EXPECT_GT(options.size(), 30u);
}

}  // namespace
}  // namespace surf
