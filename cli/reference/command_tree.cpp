// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_tree.h"

#include <algorithm>
#include <sstream>

#include "../app.h"

namespace surf::cli::reference {
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string form_of_value(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  std::string form = option.get_option_text();
  if (form.empty()) {
    form = option.get_type_name();
    if (option.nonpositional() && option.get_items_expected_min() > 1)
      form += " x" + std::to_string(option.get_items_expected_min());
  }
  form.resize(std::min(form.find(":{"), form.size()));  // what CLI11 adds of its own checks
  return form;
}

std::string names_of(const CLI::Option& option) {
  if (!option.nonpositional()) return option.get_name();
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  return names;
}

void add_options(const CLI::App& app, CommandText& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || option == app.get_help_ptr()) continue;
    const std::string heading = option->nonpositional() ? option->get_group() : "Input";
    auto group = std::ranges::find(command.options, heading, &OptionGroup::heading);
    if (group == command.options.end()) group = command.options.insert(group, {heading, {}});
    group->options.push_back(
        {names_of(*option), form_of_value(*option), in_one_line(option->get_description())});
  }
  std::ranges::stable_sort(command.options, [](const OptionGroup& a, const OptionGroup& b) {
    return (a.heading == "Input") > (b.heading == "Input");
  });
}

/// Examples are indented below "Examples:"; the rest is notes.
void split_footer(const std::string& footer, CommandText& command) {
  std::istringstream lines(footer);
  bool within = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "Examples:" || line == "Example:") within = true;
    else if (within && line.starts_with("  ")) command.examples += line.substr(2) + "\n";
    else {
      within = false;
      command.notes += line + "\n";
    }
  }
  while (command.notes.ends_with("\n\n")) command.notes.pop_back();
  command.notes.erase(0, command.notes.find_first_not_of('\n'));
}

CommandText read(const CLI::App& app, const std::string& parent) {
  CommandText command;
  command.group = app.get_group();
  command.name = parent.empty() ? app.get_name() : parent + " " + app.get_name();
  command.title = in_one_line(app.get_description());
  add_options(app, command);
  split_footer(app.get_footer(), command);
  for (const CLI::App* sub : app.get_subcommands(nullptr))
    if (!sub->get_group().empty()) command.commands.push_back(read(*sub, command.name));
  command.usage = command.name;
  const bool has_options = std::ranges::any_of(
      command.options, [](const OptionGroup& g) { return g.heading != "Input"; });
  if (has_options) command.usage += " [OPTIONS]";
  for (const OptionGroup& group : command.options)
    for (const OptionText& option : group.options)
      if (group.heading == "Input")
        command.usage += " " + option.names + (option.form.ends_with("...") ? "..." : "");
  if (!command.commands.empty()) command.usage += " [COMMAND]";
  return command;
}

}  // namespace

CommandText read_program() {
  Action action;
  return read(*make_app(action, ""), "");
}

}  // namespace surf::cli::reference
