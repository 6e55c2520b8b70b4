// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "commands.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "terminal.h"

// Completion scripts are made from the program's own options, so that they never get out of date.

namespace surf::cli {
namespace {

constexpr const char* examples = R"(Examples:
  source <(semsurf completion bash)                                    # in ~/.bashrc
  semsurf completion zsh > "${fpath[1]}/_semsurf"
  semsurf completion fish > ~/.config/fish/completions/semsurf.fish)";

// One option, or the positional arguments.
struct Argument {
  std::vector<std::string> names;   // "-o", "--output"; empty for positionals
  std::string description;
  bool takes_value = false;
  bool files = false, folders = false;   // what is offered as its value, besides the words
  std::string words;                     // separated by spaces

  bool offers() const { return files || folders || !words.empty(); }
};

struct Command {
  std::string name, description;
  std::vector<Argument> options;
  Argument positional;
  std::vector<Command> actions;     // subcommands of its own
};

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text;
}

std::string material_names() {
  std::string names;
  for (const mc::Material& m : io::builtin_materials())
    names += (names.empty() ? "" : " ") + m.name;
  return names;
}

void add_word(const std::string& word, std::string& words) { words += (words.empty() ? "" : " ") + word; }

// What is offered for a type as help shows it: "FILE.json" and "SCENE.toml" are names of files, "FOLDER|off" a folder or
// a word, "SE|BSE|...|valid" words among others. A single name in capitals stands for something that nobody can list.
// CLI11 adds what it checks itself: "auto|rows:{auto,rows}".
void read_values(std::string type, Argument& a) {
  type.resize(std::min(type.find(":{"), type.size()));
  const bool choice = type.find('|') != std::string::npos;
  std::istringstream parts(type);
  for (std::string part; std::getline(parts, part, '|');) {
    if (part == "FILE" || part.starts_with("FILE.") || part == "SCENE.toml") a.files = true;
    else if (part == "FOLDER") a.folders = true;
    else if (part == "MATERIAL") add_word(material_names(), a.words);
    else if (choice && part != "...") add_word(part, a.words);
  }
}

Argument read_argument(const CLI::Option& option) {
  Argument a;
  for (const std::string& name : option.get_snames()) a.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) a.names.push_back("--" + name);
  a.description = first_line(option.get_description());
  a.takes_value = option.get_items_expected_max() > 0;
  read_values(option.get_type_name(), a);
  return a;
}

Command read_command(const CLI::App& app) {
  Command command{app.get_name(), app.get_description(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;   // a former name
    if (option->nonpositional())
      command.options.push_back(read_argument(*option));
    else
      command.positional = read_argument(*option);
  }
  for (const CLI::App* sub : app.get_subcommands(nullptr)) {
    command.actions.push_back(read_command(*sub));
    add_word(sub->get_name(), command.positional.words);
  }
  return command;
}

std::string option_names(const Command& command) {
  std::string names;
  for (const Argument& option : command.options)
    for (const std::string& name : option.names) names += (names.empty() ? "" : " ") + name;
  return names;
}

std::string bash_values(const Argument& a) {
  if (!a.offers()) return ":";
  std::string what = a.files ? " -f" : a.folders ? " -d" : "";
  if (!a.words.empty()) what += fmt::format(" -W \"{}\"", a.words);
  return fmt::format("COMPREPLY=($(compgen{} -- \"$cur\"))", what);
}

// What bash needs of a command, and of its own: which words lead to it, the values of its options,
// what is offered elsewhere. Inside the script "library build" is called library_build.
struct BashParts {
  std::string words, values, rest;

  void add(const Command& c, const std::string& parent) {
    const std::string name = parent.empty() ? c.name : parent + "_" + c.name;
    words += fmt::format("      {}:{}) command={} ;;\n", parent, c.name, name);
    for (const Argument& option : c.options) {
      if (!option.takes_value) continue;
      std::string patterns;
      for (const std::string& text : option.names)
        patterns += fmt::format("{}{}:{}", patterns.empty() ? "" : "|", name, text);
      values += fmt::format("    {}) {}; return ;;\n", patterns, bash_values(option));
    }
    rest += fmt::format(
        "    {}) if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W \"{}\" -- \"$cur\"))\n"
        "      else {}; fi ;;\n",
        name, option_names(c), bash_values(c.positional));
    for (const Command& action : c.actions) add(action, name);
  }
};

std::string bash_script(const Command& top) {
  BashParts parts;
  for (const Command& c : top.actions) parts.add(c, "");
  return fmt::format(R"(# bash completion for semsurf, made by "semsurf completion bash"
_semsurf() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command= word
  COMPREPLY=()
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case $command:$word in
{}    esac
  done
  case $command:$prev in
{}  esac
  case $command in
    "") COMPREPLY=($(compgen -W "{} {}" -- "$cur")) ;;
{}  esac
}}
complete -o filenames -F _semsurf semsurf
)",
                     parts.words, parts.values, top.positional.words, option_names(top),
                     parts.rest);
}

// Text inside single quotes of zsh's _arguments, or of fish.
std::string quoted(const std::string& text, const std::string& special) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (special.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_values(const Argument& a) {
  const char* const names = a.files ? "_files" : a.folders ? "_files -/" : "";
  if (!*names) return a.words.empty() ? ":value: " : fmt::format(":value:({})", a.words);
  if (a.words.empty()) return fmt::format(":file:{}", names);
  return fmt::format(":value:{{{}; compadd -- {}}}", names, a.words);
}

// The body of a function that completes a command's words; $words[1] is the command.
std::string zsh_body(const Command& c, const std::string& indent) {
  if (c.actions.empty()) {
    std::string out = indent + "_arguments";
    for (const Argument& option : c.options)
      for (const std::string& name : option.names)
        out += fmt::format(" \\\n{}  '*{}[{}]{}'", indent, name,
                           quoted(option.description, "[]:"),
                           option.takes_value ? zsh_values(option) : "");
    if (c.positional.takes_value)
      out += fmt::format(" \\\n{}  '*{}'", indent, zsh_values(c.positional));
    return out;
  }
  std::string names, cases;
  for (const Command& action : c.actions) {
    names += fmt::format("{}    '{}:{}'\n", indent, action.name, quoted(action.description, ":"));
    cases += fmt::format("{0}  {1})\n{2} ;;\n", indent, action.name,
                         zsh_body(action, indent + "    "));
  }
  return fmt::format(R"({0}commands=(
{1}{0})
{0}if (( CURRENT == 2 )); then
{0}  _describe command commands
{0}  return
{0}fi
{0}command=$words[2]
{0}shift words
{0}(( CURRENT-- ))
{0}case $command in
{2}{0}esac)",
                     indent, names, cases);
}

std::string zsh_script(const Command& top) {
  return fmt::format(R"(#compdef semsurf
# zsh completion for semsurf, made by "semsurf completion zsh"
_semsurf() {{
  local -a commands
  local command
{}
}}
if [[ $funcstack[1] == _semsurf ]]; then _semsurf "$@"; else compdef _semsurf semsurf; fi
)",
                     zsh_body(top, "  "));
}

// `seen`: a condition of fish that holds where this command has been typed.
void add_fish(const Command& c, const std::string& seen, std::string& out) {
  const auto values = [](const Argument& a) {
    if (a.files) return a.words.empty() ? std::string(" -F") : fmt::format(" -rFa '{}'", a.words);
    if (!a.offers()) return std::string(a.takes_value ? " -x" : "");
    const char* const folders = !a.folders ? "" : a.words.empty() ? "(__fish_complete_directories)"
                                                                  : "(__fish_complete_directories) ";
    return fmt::format(" -xa '{}{}'", folders, a.words);
  };
  const std::string here = fmt::format("complete -c semsurf -n '{}'", seen);
  for (const Argument& option : c.options) {
    if (seen.empty()) break;
    out += here;
    for (const std::string& name : option.names)
      out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    out += values(option) + fmt::format(" -d '{}'\n", quoted(option.description, "\\"));
  }
  if (c.actions.empty()) {
    if (c.positional.offers()) out += here + values(c.positional) + "\n";
    return;
  }
  const std::string none_yet =
      seen.empty() ? "__fish_use_subcommand"
                   : fmt::format("'{}; and not __fish_seen_subcommand_from {}'", seen,
                                 c.positional.words);
  for (const Command& action : c.actions) {
    out += fmt::format("complete -c semsurf -n {} -a {} -d '{}'\n", none_yet, action.name,
                       quoted(action.description, "\\"));
    add_fish(action, fmt::format("{}{}__fish_seen_subcommand_from {}", seen,
                                 seen.empty() ? "" : "; and ", action.name), out);
  }
}

std::string fish_script(const Command& top) {
  std::string out = "# fish completion for semsurf, made by \"semsurf completion fish\"\n"
                    "complete -c semsurf -f\n";
  add_fish(top, "", out);
  return out;
}

void print_script(const CLI::App& app, const std::string& shell) {
  const Command top = read_command(app);
  if (shell == "bash")
    print("{}", bash_script(top));
  else if (shell == "zsh")
    print("{}", zsh_script(top));
  else if (shell == "fish")
    print("{}", fish_script(top));
  else
    throw UsageError("completion", shell.empty() ? "no shell is given" : "unknown shell " + shell,
                     "Choose bash, zsh or fish");
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "A completion script for the shell");
  sub->add_option("SHELL", *shell, "The shell")->type_name("bash|zsh|fish");
  sub->footer(examples);
  sub->callback([shell, &app, &action] {
    action = [shell, &app] {
      print_script(app, *shell);
      return 0;
    };
  });
}

}  // namespace surf::cli
