// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/command_words.h"

#include <algorithm>
#include <cstdlib>

#include "surf/core/error.h"

namespace surf::parameters_detail {
namespace {

/// The value as a person writes it, "1keV", if that text is read back exactly; else its exact text.
std::string shown(const Parameter& about, const Field& field) {
  const std::string text = field.text();
  if (field.kind() != FieldKind::number || text.empty()) return text;
  const double value = std::strtod(text.c_str(), nullptr);
  const std::string with_unit = format_value(value, about.unit);
  try {
    return parse_value(with_unit, about, about.name) == value ? with_unit : text;
  } catch (const UsageError&) {
    return text;
  }
}

}  // namespace

void add_command_words(const Parameter& about, const Field& field, const std::string& usual,
                       const OptionNames& names, std::vector<std::string>& words) {
  if (!about.recorded || !field.given() || field.text() == usual) return;
  std::string option(about.last_name());
  std::ranges::replace(option, '_', '-');
  const auto other = names.find(about.name);
  words.push_back(other != names.end() ? other->second : "--" + option);
  if (field.kind() != FieldKind::flag) words.push_back(shown(about, field));
}

}  // namespace surf::parameters_detail
