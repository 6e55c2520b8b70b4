// SPDX-License-Identifier: GPL-3.0-or-later
#include "property_values.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::pv {

bool PropertyValues::keep(const std::string& name, std::string text) {
  const std::size_t end = name.find('=');
  if (end != name.npos && name.substr(end + 1) == text) text.clear();
  std::string& there = texts_[name.substr(0, end)];
  if (there == text) return false;
  there = std::move(text);
  return true;
}

bool PropertyValues::set(const char* name, const char* text) {
  return keep(name, text ? text : "");
}

bool PropertyValues::set(const char* name, double value) { return keep(name, format_exact(value)); }

bool PropertyValues::set(const char* name, const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + format_exact(value);
  return keep(name, text);
}

std::string PropertyValues::text(const std::string& name) const {
  const auto found = texts_.find(name);
  return found == texts_.end() ? std::string() : found->second;
}

double PropertyValues::number(const std::string& name) const {
  return std::strtod(text(name).c_str(), nullptr);
}

void PropertyValues::take(const Parameter& about, Field& field) const {
  const auto found = texts_.find(about.name);
  if (found == texts_.end() || found->second.empty()) return;
  const std::string& text = found->second;
  if (field.kind() == FieldKind::choice) {
    const auto choices = field.choices();
    const double index = number(about.name);
    if (!(index >= 0 && index < static_cast<double>(choices.size())) || index != std::floor(index))
      throw UsageError(about.subject(), fmt::format("there is no choice {}", text),
                       fmt::format("Choose 0 to {}", choices.size() - 1));
    field.read(choices[static_cast<std::size_t>(index)], about.subject());
    return;
  }
  field.read(text, about.subject());
}

std::string PropertyValues::all() const {
  std::string out;
  for (const auto& [name, text] : texts_) out += fmt::format("{}={}|", name, text);
  return out;
}

}  // namespace surf::pv
