// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "commands.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"

// Completion scripts are made from the program's own options, so that they never get out of date.

namespace surf::cli {
namespace {

constexpr const char* examples = R"(Examples:
  source <(semsurf completion bash)                                    # in ~/.bashrc
  semsurf completion zsh > "${fpath[1]}/_semsurf"
  semsurf completion fish > ~/.config/fish/completions/semsurf.fish)";

enum class Values { none, files, words };

// One option, or the positional arguments.
struct Argument {
  std::vector<std::string> names;   // "-o", "--output"; empty for positionals
  std::string description;
  bool takes_value = false;
  Values values = Values::none;
  std::string words;                // separated by spaces
};

struct Command {
  std::string name, description;
  std::vector<Argument> options;
  Argument positional;
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

Argument read_argument(const CLI::Option& option) {
  Argument a;
  for (const std::string& name : option.get_snames()) a.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) a.names.push_back("--" + name);
  a.description = first_line(option.get_description());
  const std::string type = option.get_type_name();
  a.takes_value = option.get_items_expected_max() > 0;
  if (type == "FILE") {
    a.values = Values::files;
  } else if (type == "MATERIAL") {
    a.values = Values::words;
    a.words = material_names();
  } else if (type.find('|') != std::string::npos) {
    a.values = Values::words;
    a.words = type;
    for (char& c : a.words)
      if (c == '|') c = ' ';
  }
  return a;
}

Command read_command(const CLI::App& app) {
  Command command{app.get_name(), app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional())
      command.options.push_back(read_argument(*option));
    else
      command.positional = read_argument(*option);
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
  switch (a.values) {
    case Values::files: return "COMPREPLY=($(compgen -f -- \"$cur\"))";
    case Values::words: return fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$cur\"))", a.words);
    case Values::none: break;
  }
  return ":";
}

std::string bash_script(const Command& top, const std::vector<Command>& commands) {
  std::string names, values, rest;
  for (const Command& c : commands) {
    names += (names.empty() ? "" : "|") + c.name;
    for (const Argument& option : c.options) {
      if (!option.takes_value) continue;
      std::string patterns;
      for (const std::string& name : option.names)
        patterns += fmt::format("{}{}:{}", patterns.empty() ? "" : "|", c.name, name);
      values += fmt::format("    {}) {}; return ;;\n", patterns, bash_values(option));
    }
    rest += fmt::format(
        "    {}) if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W \"{}\" -- \"$cur\"))\n"
        "      else {}; fi ;;\n",
        c.name, option_names(c), bash_values(c.positional));
  }
  std::string words = names;
  for (char& c : words)
    if (c == '|') c = ' ';
  return fmt::format(R"(# bash completion for semsurf, made by "semsurf completion bash"
_semsurf() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command= word
  COMPREPLY=()
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case $word in {}) command=$word; break ;; esac
  done
  case $command:$prev in
{}  esac
  case $command in
    "") COMPREPLY=($(compgen -W "{} {}" -- "$cur")) ;;
{}  esac
}}
complete -o filenames -F _semsurf semsurf
)",
                     names, values, words, option_names(top), rest);
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
  switch (a.values) {
    case Values::files: return ":file:_files";
    case Values::words: return fmt::format(":value:({})", a.words);
    case Values::none: break;
  }
  return ":value: ";
}

std::string zsh_script(const std::vector<Command>& commands) {
  std::string names, cases;
  for (const Command& c : commands) {
    names += fmt::format("    '{}:{}'\n", c.name, quoted(c.description, ":"));
    cases += fmt::format("    {}) _arguments", c.name);
    for (const Argument& option : c.options)
      for (const std::string& name : option.names)
        cases += fmt::format(" \\\n      '*{}[{}]{}'", name, quoted(option.description, "[]:"),
                             option.takes_value ? zsh_values(option) : "");
    if (c.positional.takes_value)
      cases += fmt::format(" \\\n      '*{}'", zsh_values(c.positional));
    cases += " ;;\n";
  }
  return fmt::format(R"(#compdef semsurf
# zsh completion for semsurf, made by "semsurf completion zsh"
_semsurf() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
if [[ $funcstack[1] == _semsurf ]]; then _semsurf "$@"; else compdef _semsurf semsurf; fi
)",
                     names, cases);
}

std::string fish_script(const std::vector<Command>& commands) {
  std::string out = "# fish completion for semsurf, made by \"semsurf completion fish\"\n"
                    "complete -c semsurf -f\n";
  const auto values = [](const Argument& a) {
    if (a.values == Values::files) return std::string(" -F");
    if (a.values == Values::words) return fmt::format(" -xa '{}'", a.words);
    return std::string(a.takes_value ? " -x" : "");
  };
  for (const Command& c : commands) {
    out += fmt::format("complete -c semsurf -n __fish_use_subcommand -a {} -d '{}'\n", c.name,
                       quoted(c.description, "\\"));
    const std::string here =
        fmt::format("complete -c semsurf -n '__fish_seen_subcommand_from {}'", c.name);
    for (const Argument& option : c.options) {
      out += here;
      for (const std::string& name : option.names)
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      out += values(option) + fmt::format(" -d '{}'\n", quoted(option.description, "\\"));
    }
    if (c.positional.values != Values::none) out += here + values(c.positional) + "\n";
  }
  return out;
}

void print_script(const CLI::App& app, const std::string& shell) {
  std::vector<Command> commands;
  for (const CLI::App* sub : app.get_subcommands(nullptr)) commands.push_back(read_command(*sub));
  if (shell == "bash")
    fmt::print("{}", bash_script(read_command(app), commands));
  else if (shell == "zsh")
    fmt::print("{}", zsh_script(commands));
  else if (shell == "fish")
    fmt::print("{}", fish_script(commands));
  else
    throw UsageError("completion", shell.empty() ? "no shell is given" : "unknown shell " + shell,
                     "Choose bash, zsh or fish");
}

}  // namespace

void add_completion(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "A completion script for the shell");
  sub->add_option("SHELL", *shell, "The shell")->type_name("bash|zsh|fish");
  sub->group("Commands");
  sub->footer(examples);
  sub->callback([shell, &app, &action] {
    action = [shell, &app] {
      print_script(app, *shell);
      return 0;
    };
  });
}

}  // namespace surf::cli
