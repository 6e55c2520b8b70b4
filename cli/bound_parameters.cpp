// SPDX-License-Identifier: GPL-3.0-or-later
#include "bound_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace surf::cli {
namespace {

/// "help (default)", over as many lines as it takes.
std::string help_of(const Parameter& about, const Field& field, const std::string& own,
                    bool positional) {
  std::string text = own.empty() ? about.help : own;
  if (const std::string limits = format_limits(about);
      !limits.empty() && field.kind() != FieldKind::choice)
    text += ", " + limits;
  if (field.kind() == FieldKind::list && !positional) text += "; may be repeated";
  if (!about.otherwise.empty()) return text + fmt::format(" ({})", about.otherwise);
  if (field.kind() == FieldKind::flag || !field.given()) return text;
  std::string usual = field.text();
  if (field.kind() == FieldKind::number) usual = format_value(std::stod(usual), about.unit);
  return text + fmt::format(" ({})", usual);
}

/// Breaks between words, so that help stays within `width` columns.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string out, line;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", from), text.size());
    const std::string word = text.substr(from, end - from);
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      out += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    if (end < text.size() && text[end] == '\n') {
      out += line + "\n";
      line.clear();
    }
    from = end + 1;
  }
  return out + line;
}

constexpr std::size_t help_width = 74;

/// What an option stands for, while what it writes to is there: another option may come where it
/// was.
struct BoundOption {
  std::weak_ptr<const GivenTexts> lives;
  std::string parameter;
  std::optional<FileRole> file;  // none: the command reads the option by itself
  bool shows_default = false;
};

std::map<const CLI::Option*, BoundOption>& bound_options() {
  static std::map<const CLI::Option*, BoundOption> all;
  return all;
}

/// Of options that commands read by themselves.
std::map<const CLI::Option*, FileRole>& own_roles() {
  static std::map<const CLI::Option*, FileRole> all;
  return all;
}

const BoundOption* find_bound(const CLI::Option& option) {
  const auto found = bound_options().find(&option);
  return found == bound_options().end() || found->second.lives.expired() ? nullptr : &found->second;
}

}  // namespace

std::string option_name(std::string_view parameter) {
  std::string name(parameter.substr(parameter.rfind('.') + 1));  // npos + 1 is 0
  std::ranges::replace(name, '_', '-');
  return "--" + name;
}

std::string option_of(const CLI::App& command, std::string_view parameter) {
  for (const CLI::Option* option : command.get_options())
    if (const BoundOption* bound = find_bound(*option);
        bound && bound->parameter == parameter && !option->get_group().empty())
      return option->nonpositional() ? "--" + option->get_lnames().front() : option->get_name();
  const std::string name = option_name(parameter);
  return command.get_option_no_throw(name) ? name : std::string();
}

std::optional<FileRole> file_role(const CLI::Option& option) {
  if (const BoundOption* const bound = find_bound(option); bound && bound->file) return bound->file;
  const auto found = own_roles().find(&option);
  return found == own_roles().end() ? std::nullopt : std::optional(found->second);
}

void describe_texts(ParameterVisitor& visit, std::vector<std::string>& texts,
                    const Parameter& about) {
  visit.form(
      about, [&] { return fmt::format("{}", fmt::join(texts, " ")); },
      [&](std::string_view text, const std::string&) { texts.emplace_back(text); },
      FieldKind::list);
}

bool shows_default(const CLI::Option& option) {
  const BoundOption* const bound = find_bound(option);
  return bound && bound->shows_default;
}

CLI::Option* with_role(CLI::Option* option, FileRole role) {
  own_roles()[option] = role;
  return option;
}

void BoundParameters::stands_for(const CLI::Option* option, const std::string& parameter) {
  bound_options()[option] = {given_, parameter, std::nullopt, false};
}

void BoundParameters::declare(CLI::App& app, const std::string& group, const Parameter& about,
                              const Field& field, const std::vector<std::string>& only) {
  if (!only.empty() && std::ranges::find(only, about.name) == only.end()) return;
  const auto found = looks.find(about.name);
  const OptionLook look = found != looks.end() ? found->second : OptionLook{};
  if (look.hidden) return;
  const std::string name = look.name.empty() ? option_name(about.name) : look.name;
  const std::string help = wrapped(help_of(about, field, look.help, look.positional), help_width);
  const auto given = given_;
  const std::string key = about.name;
  std::string heading = group;
  if (heading.empty()) {
    auto known = headings.find(about.name);
    if (known == headings.end()) known = headings.find(about.name.substr(0, about.name.find('.')));
    if (known != headings.end()) heading = known->second;
  }
  const auto declare_as = [&](const std::string& as, const std::string& in_group) {
    CLI::Option* option = nullptr;
    if (field.kind() == FieldKind::flag) {
      option = app.add_flag_callback(
          as, [given, key] { (*given)[key] = {"on"}; }, help);
    } else {
      option = app.add_option_function<std::vector<std::string>>(
          as,
          [given, key](const std::vector<std::string>& texts) {
            auto& all = (*given)[key];
            all.insert(all.end(), texts.begin(), texts.end());
          },
          help);
      option->type_name(form_of(about, field))
          ->option_text(form_of(about, field))
          ->allow_extra_args(look.positional && field.kind() == FieldKind::list);
      if (look.positional)
        option->expected(field.kind() == FieldKind::list ? -1 : 1)->required(false);
      else if (field.kind() != FieldKind::list)
        option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::Throw);
      else option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
    option->group(in_group);
    bound_options()[option] = {given_, about.name, about.file,
                               look.help.empty() && about.otherwise.empty()};
  };
  declare_as(name, heading);
  for (const std::string& former : look.former) declare_as(former, "");
}

void BoundParameters::take(const Parameter& about, Field& field, const GivenTexts& given) {
  const auto found = given.find(about.name);
  if (found == given.end()) return;
  if (field.kind() != FieldKind::list) {
    field.read(found->second.back(), about.subject());
    return;
  }
  field.clear();
  for (const std::string& text : found->second) field.add(text, about.subject());
}

}  // namespace surf::cli
