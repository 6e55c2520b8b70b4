// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "app.h"
#include "bound_parameters.h"
#include "commands.h"
#include "complete.h"
#include "exit_codes.h"
#include "failure.h"
#include "file_uses.h"
#include "joined_team.h"
#include "options.h"
#include "run.h"
#include "surf/core/error.h"
#include "surf/core/field_words.h"
#include "surf/core/nearest.h"
#include "surf/core/try_thread.h"
#include "surf/core/words.h"
#include "surf/workflow/version.h"
#include "terminal.h"

namespace {

using namespace surf;
using namespace surf::cli;

constexpr const char* run_examples = R"(Examples:
  semsurf simulate cube.stl --material Si --substrate Si --tilt 40 -o cube.exr -o cube.png
      the secondary-electron image of a mesh (in nm) at 1 keV, as data and as a picture
  semsurf simulate samples/mesa80.toml --energy 3keV --electrons 500 -o mesa.vti
      a scene file, with two of its settings changed, for ParaView
  semsurf mesh part.obj --unit um --repair --mesh-tolerance 1nm -o part.stl
      a sound mesh of fewer triangles, nowhere more than 1 nm off
  semsurf info mesa.vti
      what is in a file, and how it was made

'semsurf simulate --help' explains units and options.)";

// CLI11's help with one empty line between groups, not two.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(34);
    label("Positionals", "Input");
    label("SUBCOMMAND", "COMMAND");
  }
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::string help = CLI::Formatter::make_help(app, name, mode);
    const std::string usage =
        CLI::detail::find_and_replace(help, " [] ", " ");  // of a hidden input
    return CLI::detail::find_and_replace(usage, "\n\n\n", "\n\n");
  }
};

std::string version_text() {
  return fmt::format(
      "semsurf {}\nwith {}, CLI11 {}\nCopyright the semsurf authors. Licence GPL-3.0-or-later; no "
      "warranty.",
      workflow::version(), workflow::library_versions(), CLI11_VERSION);
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name :
         option->get_group().empty() ? std::vector<std::string>{} : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

// The innermost subcommand that was parsed, else the program.
const CLI::App& parsed_app(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : parsed_app(*chosen.front());
}

struct OptionNames {
  std::string name, letter;  // without dashes; few have a letter
};

std::vector<OptionNames> options_of(const CLI::App& app) {
  std::vector<OptionNames> options;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      options.push_back({name, option->get_snames().empty() ? "" : option->get_snames().front()});
  return options;
}

// Two names of one setting, as sem-pixel-size is pixel-size where there is no other image.
bool is_alike(std::string_view a, std::string_view b) {
  if (a.size() < b.size()) std::swap(a, b);
  return b.find('-') != b.npos && a.ends_with("-" + std::string(b));
}

// The option of this name, else the only one that is alike, else null.
const OptionNames* option_called(const std::vector<OptionNames>& options, const std::string& name) {
  const OptionNames* found = nullptr;
  int alike = 0;
  for (const OptionNames& option : options) {
    if (option.name == name) return &option;
    if (is_alike(option.name, name)) found = &option, ++alike;
  }
  return alike == 1 ? found : nullptr;
}

// `beam.tilt=30deg` is --tilt 30deg where the command has that option, and with a letter it is -o
// image.exr.
FieldWord options_for_fields(const CLI::App& app) {
  return [&app, options = options_of(app)](std::string_view field, std::string_view value) {
    const std::string bound =
        option_of(app, field);  // "--level-method" of level.method, whatever --method is
    const OptionNames* option =
        bound.starts_with("--") ? option_called(options, bound.substr(2)) : nullptr;
    if (!option) option = option_called(options, last_part(field, '-'));
    const std::string setting = value.empty() ? "" : " " + std::string(value);
    if (!option) return last_part(field, ' ') + setting;
    return (value.empty() || option->letter.empty() ? "--" + option->name : "-" + option->letter) +
           setting;
  };
}

std::string help_hint(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* a = app.get_parent(); a; a = a->get_parent())
    words = fmt::format("{} {}", a->get_name(), words);
  return fmt::format("See {} --help", words);
}

int report_extra(const CLI::App& root) {
  const CLI::App& app = parsed_app(root);
  const auto remaining = root.remaining(true);
  std::string word = remaining.empty() ? std::string() : remaining.front();
  word.resize(std::min(word.find('='), word.size()));
  const bool option = word.starts_with('-');
  std::vector<std::string> candidates = names_of_options(app);
  if (!option && !app.get_subcommands(nullptr).empty()) {
    candidates.clear();
    for (const CLI::App* sub : app.get_subcommands(nullptr))
      if (!sub->get_group().empty()) candidates.push_back(sub->get_name());
  }
  const std::string guess = nearest(word, candidates);
  print_error(fmt::format("{}: unknown {}. {}", word, option ? "option" : "command",
                          guess.empty() ? help_hint(app) : fmt::format("Did you mean {}?", guess)));
  return exit_usage;
}

/// A hidden option that was given several times; CLI11 does not name those.
std::string repeated_hidden(const CLI::App& app) {
  for (const CLI::Option* const option : app.get_options())
    if (option->get_group().empty() && option->results().size() > 1 &&
        !option->get_lnames().empty())
      return "--" + option->get_lnames().front();
  return {};
}

// "--energy: At Most 1 required but received 2", in CLI11's words.
bool report_repetition(const CLI::App& app, const CLI::ParseError& error) {
  if (!dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return false;
  static const std::regex words("(-.+|): At Most 1 required but received (\\d+)");
  const std::string text = error.what();
  std::smatch found;
  if (!std::regex_match(text, found, words)) return false;
  const std::string times = found[2] == "2" ? "twice" : found[2].str() + " times";
  const std::string name = found[1].length() > 0 ? found[1].str() : repeated_hidden(app);
  print_error(fmt::format("{}: it is given {}. Give it once", name, times));
  return true;
}

int report_parse_error(const CLI::App& root, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {  // help and version
    std::ostringstream text, unused;
    const int code = root.exit(error, text, unused);
    print("{}", text.str());
    return code;
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) return report_extra(root);
  const CLI::App& app = parsed_app(root);
  if (report_repetition(app, error)) return exit_usage;
  print_error(fmt::format("{}. {}", error.what(), help_hint(app)));
  return exit_usage;
}

// These do their work together with others; anything else is done by the leader alone.
bool is_shared(const CLI::App& app) {
  constexpr std::array shared{"simulate", "sweep", "train", "chart"};
  return std::ranges::find(shared, parsed_app(app).get_name()) != shared.end();
}

int act(const CLI::App& app, const Action& action) {
  try {
    const auto check = [&] { refuse_overlaps(parsed_app(app)); };
    if (is_shared(app)) workflow::together(team(), check);
    else check();
    return action();
  } catch (...) {
    return report_failure();
  }
}

/// The headings of help, and the commands of each in the order in which they are used.
void add_commands(CLI::App& app, Action& action, const std::string& command_line) {
  const auto group = [&](const char* heading, const auto&... add) {
    const auto added = [&](const auto& one) {
      const std::size_t before = app.get_subcommands(nullptr).size();
      if constexpr (std::is_invocable_v<decltype(one), CLI::App&, Action&>) one(app, action);
      else one(app, action, command_line);
      for (std::size_t i = before; i < app.get_subcommands(nullptr).size(); ++i)
        app.get_subcommands(nullptr)[i]->group(heading);
    };
    (added(add), ...);
  };
  group("SEM", add_simulate, add_sweep, add_train, add_predict, add_estimate, add_profile);
  group("AFM", add_level, add_clean, add_noise, add_tip, add_erode, add_dilate, add_open, add_close,
        add_certainty, add_survey);
  group("AFM + SEM", add_sample, add_register, add_calibrate, add_reconstruct, add_refine,
        add_compare);
  group("Surfaces and files", add_info, add_view, add_mesh, add_materials);
  group("Set-up and study", add_library, add_chart, add_completion);
  group("", add_former_join);
}

int parse_and_act(const std::vector<std::string>& arguments) {
  Action action;
  const std::unique_ptr<CLI::App> made = make_app(action, quoted_command(arguments));
  CLI::App& app = *made;
  if (arguments.size() > 1 && arguments[1] == "__complete") {
    print("{}", completions(app, {arguments.begin() + 2, arguments.end()}));
    return 0;
  }
  try {
    std::vector<std::string> words(arguments.rbegin(),
                                   arguments.rend());  // CLI11 wants the last one first
    if (!words.empty()) words.pop_back();              // the program
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error);
  }
  struct Words {
    ~Words() { call_fields(nullptr); }  // they know the command by reference
  } words_of_command;
  call_fields(options_for_fields(parsed_app(app)));
  if (!action) {
    fmt::print(messages(), "{}", app.help());
    return exit_usage;
  }
  const std::string command = app.get_subcommands().front()->get_name();
  if (!is_shared(app) && leave_to_leader(command)) return 0;
  const int code = act(app, action);
  if (take_refused_threads() > 0)
    print_note(
        "the system refused threads (ulimit -u, ulimit -v): fewer than wanted did the work, with "
        "the same "
        "result");
  return code;
}

}  // namespace

namespace surf::cli {

std::unique_ptr<CLI::App> make_app(Action& action, const std::string& command_line) {
  auto app = std::make_unique<CLI::App>(
      "Scanning electron microscope images of surfaces, by Monte Carlo "
      "simulation",
      "semsurf");
  app->formatter(std::make_shared<HelpFormatter>());
  // Before the version, so that it is known when that is told.
  const auto as_json = std::make_shared<bool>(false);
  app->add_flag("--json", *as_json, "With --version: as JSON");
  app->set_version_flag(
      "-V,--version", [as_json] { return *as_json ? workflow::version_json() : version_text(); },
      "Versions of semsurf and its libraries");
  app->footer(run_examples);
  app->allow_windows_style_options(false);
  add_commands(*app, action, command_line);
  return app;
}

int run(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
  speak_to(out, err);
  call_fields(nullptr);
  int code = 0;
  try {
    code = parse_and_act(arguments);
    flush();
  } catch (...) {
    code = report_failure();
  }
  speak_to(nullptr, nullptr);
  return code;
}

}  // namespace surf::cli
