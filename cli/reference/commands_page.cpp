// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "command_tree.h"
#include "markdown.h"
#include "pages.h"

namespace surf::cli::reference {
namespace {

std::string anchor(std::string heading) {
  std::ranges::replace(heading, ' ', '-');
  return "#" + heading;
}

std::string table_of(const OptionGroup& group) {
  std::vector<std::vector<std::string>> rows;
  for (const OptionText& o : group.options)
    rows.push_back(
        {code(o.names + (o.form.empty() || o.names == o.form ? "" : " " + o.form)), cell(o.help)});
  return fmt::format("**{}**\n\n", group.heading) +
         table({group.heading == "Input" ? "Input" : "Option", "Meaning"}, rows) + "\n";
}

std::string section(const CommandText& c, int depth) {
  std::string text = fmt::format(
      "{} {}\n\n{}.\n\n", std::string(static_cast<std::size_t>(depth), '#'), c.name, c.title);
  text += fmt::format("```sh\n{}\n```\n\n", c.usage);
  if (!c.examples.empty()) text += fmt::format("Examples:\n\n```sh\n{}```\n\n", c.examples);
  for (const OptionGroup& group : c.options) text += table_of(group);
  if (!c.notes.empty()) text += fmt::format("```text\n{}```\n\n", c.notes);
  for (const CommandText& sub : c.commands) text += section(sub, depth + 1);
  return text;
}

}  // namespace

std::string commands_page() {
  const CommandText program = read_program();
  std::string text = page_head(
      "Commands",
      "All commands of `semsurf` with their options. `semsurf COMMAND --help` shows the same in a "
      "terminal.\n"
      "What holds where an option is not given stands in parentheses at the end of its line.\n"
      "Bare lengths are nm, bare energies eV, bare angles degrees; texts may carry a unit: "
      "`5mrad`, `1.5keV`, `2um`.\n"
      "An option whose form ends in `...` may be repeated.");
  text += fmt::format("```sh\n{}```\n\n", program.examples);
  std::string group;
  for (const CommandText& c : program.commands) {
    if (c.group != group) text += fmt::format("{}**{}**\n\n", group.empty() ? "" : "\n", c.group);
    group = c.group;
    text += fmt::format("- [`{}`]({}): {}\n", c.name, anchor(c.name), c.title);
  }
  text += "\n";
  for (const CommandText& c : program.commands) {
    if (c.group != group) text += fmt::format("## {}\n\n", c.group);
    group = c.group;
    text += section(c, 3);
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace surf::cli::reference
