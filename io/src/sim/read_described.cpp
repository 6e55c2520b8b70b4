// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/read_described.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sim/scene_parts.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

std::string group_of(const std::string& name) { return name.substr(0, name.rfind('.')); }

}  // namespace

void TomlParameters::visit(const Parameter& about, Field& field) {
  const std::string group = group_of(about.name), key(about.last_name());
  auto known = std::ranges::find(known_, group, [](const auto& one) { return one.first; });
  if (known == known_.end()) known = known_.insert(known_.end(), {group, {}});
  known->second.push_back(key);
  const auto table = root_.table(group);
  if (!table || !table->has(key)) return;
  const std::vector<std::string> words = table->words(key);
  const std::string place = table->place(key);
  const bool is_flag = words.size() == 1 && (words[0] == "true" || words[0] == "false");
  if (is_flag && field.kind() != FieldKind::flag)
    throw UsageError(place, "the value is neither a finite number nor a text",
                     fmt::format("Write {}", format_limits(about).empty() ? form_of(about, field)
                                                                          : format_limits(about)));
  if (field.kind() == FieldKind::list)
    for (const std::string& word : words) field.add(word, place);
  else field.read(fmt::format("{}", fmt::join(words, ",")), place);
}

void TomlParameters::refuse_others() const {
  for (const auto& [group, keys] : known_)
    if (const auto table = root_.table(group)) table->allow(keys);
}

void at_parameters(const TomlTable& root, const std::function<void()>& work) {
  try {
    work();
  } catch (const UsageError& error) {
    if (!error.subject().starts_with('`') || error.subject().find('.') == std::string::npos) throw;
    const std::string name = error.subject().substr(1, error.subject().find('`', 1) - 1);
    const auto table = root.has(group_of(name)) ? root.table(group_of(name)) : std::nullopt;
    const std::string key = name.substr(name.rfind('.') + 1);
    if (!table || !table->has(key)) throw;
    throw UsageError(table->place(key), with_scene_words(error.reason()),
                     with_scene_words(error.remedy()));
  }
}

}  // namespace surf::io
