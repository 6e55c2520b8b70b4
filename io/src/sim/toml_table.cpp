// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that knows toml++.
#include "sim/toml_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "sim/suggest.h"
#include "sim/toml_depth.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::io {

struct TomlTable::Impl {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table;
  std::string file;
  std::string path;  // "height_field"; empty for the root
};

namespace {

std::string place_of(const std::string& file, const std::string& path, const toml::node* node) {
  const auto line = node ? node->source().begin.line : 0;
  return fmt::format("{}{}{}{}", file, line > 0 ? fmt::format(", line {}", line) : "",
                     path.empty() ? "" : ", ", path);
}

[[noreturn]] void refuse(const std::string& place, const std::string& reason,
                         const std::string& remedy) {
  throw UsageError(place, reason, remedy);
}

/// A number in native units, or a text that `parse` understands.
template <class Parse>
double quantity(const toml::node& node, const std::string& place, const Parse& parse) {
  if (const auto text = node.value_exact<std::string>()) return parse(*text, place);
  const auto number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number || !std::isfinite(*number)) {
    refuse(place, "the value is neither a finite number nor a text with a unit",
           "Write for example 2 or \"2nm\"");
  }
  return *number;
}

std::vector<double> split_lengths(std::string_view text, std::string_view separators,
                                  const std::string& place) {
  std::vector<double> values;
  for (;;) {
    const std::size_t end = text.find_first_of(separators);
    values.push_back(parse_length_nm(text.substr(0, end), place));
    if (end == std::string_view::npos) return values;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : *impl_->table) names.emplace_back(key.str());
  return names;
}

TomlTable TomlTable::parse(std::string_view text, const std::string& file) {
  check_key_depth(text, file);  // toml++ calls itself for each part of a key
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(text, file));
    const toml::table* const table = root.get();
    return TomlTable(std::make_shared<Impl>(Impl{std::move(root), table, file, {}}));
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw FileError(fmt::format("{}, line {}, column {}", file, at.line, at.column),
                    std::string(error.description()), "Correct the TOML text there");
  }
}

std::string TomlTable::place(std::string_view key) const {
  if (key.empty()) return place_of(impl_->file, impl_->path, impl_->table);
  const toml::node* const node = impl_->table->get(key);
  const std::string dot = impl_->path.empty() ? "" : ".";
  return place_of(impl_->file, fmt::format("{}{}{}", impl_->path, dot, key),
                  node ? node : impl_->table);
}

void TomlTable::allow(const std::vector<std::string>& words) const {
  for (const auto& [key, node] : *impl_->table) {
    if (std::find(words.begin(), words.end(), key.str()) != words.end()) continue;
    const auto nearest = nearest_first(key.str(), words);
    const toml::source_position at = key.source().begin;
    throw FileError(
        fmt::format("{}, line {}, column {}", impl_->file, at.line, at.column),
        fmt::format("'{}' is not known{}", key.str().substr(0, 40),
                    impl_->path.empty() ? " at the top" : fmt::format(" in {}", impl_->path)),
        nearest.empty()
            ? "Remove it"
            : fmt::format("Did you mean '{}'? Known are: {}", nearest.front(), join(words)));
  }
}

bool TomlTable::has(std::string_view key) const { return impl_->table->get(key) != nullptr; }

bool TomlTable::is_text(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  return node && node->is_string();
}

void TomlTable::require(std::string_view key, std::string_view why) const {
  if (has(key)) return;
  throw FileError(place(), fmt::format("'{}' is missing: {}", key, why), "Add it");
}

std::optional<std::string> TomlTable::text(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  auto value = node->value_exact<std::string>();
  if (!value) refuse(place(key), "the value is not a text", "Put it between quotation marks");
  return value;
}

std::optional<double> TomlTable::number(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) {
    refuse(place(key), "the value is not a finite number", "Write a plain number");
  }
  return value;
}

std::optional<std::int64_t> TomlTable::integer(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  if (const auto value = node->value_exact<std::int64_t>()) return value;
  const auto number = node->value_exact<double>();  // 1e6
  if (!number || *number != std::floor(*number) || !(std::abs(*number) < 9e15)) {
    refuse(place(key), "the value is not a whole number", "Write a whole number without quotes");
  }
  return static_cast<std::int64_t>(*number);
}

std::optional<bool> TomlTable::flag(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  const auto value = node->value_exact<bool>();
  if (!value) refuse(place(key), "the value is neither true nor false", "Write true or false");
  return value;
}

std::optional<double> TomlTable::length_nm(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  return quantity(*node, place(key), parse_length_nm);
}

std::optional<double> TomlTable::energy_ev(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  return quantity(*node, place(key), parse_energy_ev);
}

std::optional<double> TomlTable::angle_deg(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  return quantity(*node, place(key), parse_angle_deg);
}

std::optional<double> TomlTable::current_pa(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  return quantity(*node, place(key), parse_current_pa);
}

std::optional<double> TomlTable::time_us(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  return quantity(*node, place(key), parse_time_us);
}

std::vector<std::string> TomlTable::words(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  const auto word = [&](const toml::node& one) -> std::string {
    if (const auto text = one.value_exact<std::string>()) return *text;
    if (const auto whole = one.value_exact<std::int64_t>()) return std::to_string(*whole);
    if (const auto flag = one.value_exact<bool>()) return *flag ? "true" : "false";
    const auto number = one.value_exact<double>();
    if (!number || !std::isfinite(*number))
      refuse(place(key), "the value is neither a finite number nor a text with a unit",
             "Write for example 2 or \"2nm\"");
    return format_exact(*number);
  };
  const toml::array* const array = node->as_array();
  if (!array) return {word(*node)};
  std::vector<std::string> all;
  for (const toml::node& item : *array) all.push_back(word(item));
  return all;
}

std::vector<std::string> TomlTable::texts(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  const toml::array* const array = node->as_array();
  if (!array) return {*text(key)};
  std::vector<std::string> values;
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::string>();
    if (!value) refuse(place(key), "one of its values is not a text", "Put it in quotation marks");
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<double>> TomlTable::lengths_nm(std::string_view key,
                                                         std::string_view separators) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  if (const toml::array* const array = node->as_array()) {
    std::vector<double> values;
    for (const toml::node& item : *array) {
      values.push_back(quantity(item, place(key), parse_length_nm));
    }
    return values;
  }
  if (const auto text = node->value_exact<std::string>()) {
    return split_lengths(*text, separators, place(key));
  }
  return std::vector{quantity(*node, place(key), parse_length_nm)};
}

std::optional<Vec3> TomlTable::point_nm(std::string_view key) const {
  const auto values = lengths_nm(key);
  if (!values) return {};
  if (values->size() != 3) {
    refuse(place(key), fmt::format("{} numbers are given, not three", values->size()),
           "Write [x, y, z]");
  }
  return Vec3{(*values)[0], (*values)[1], (*values)[2]};
}

std::optional<TomlTable> TomlTable::table(std::string_view key) const {
  const toml::node* const node = impl_->table->get(key);
  if (!node) return {};
  const toml::table* const table = node->as_table();
  if (!table) refuse(place(key), "this is not a table", fmt::format("Write [{}]", key));
  return TomlTable(std::make_shared<Impl>(Impl{impl_->root, table, impl_->file, std::string(key)}));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> result;
  const toml::node* const node = impl_->table->get(key);
  if (!node) return result;
  const toml::array* const array = node->as_array();
  if (!array || !array->is_homogeneous<toml::table>()) {
    refuse(place(key), "this is not a list of tables", fmt::format("Write [[{}]]", key));
  }
  for (const toml::node& item : *array) {
    const std::string path = fmt::format("{}[{}]", key, result.size() + 1);
    result.push_back(
        TomlTable(std::make_shared<Impl>(Impl{impl_->root, item.as_table(), impl_->file, path})));
  }
  return result;
}

}  // namespace surf::io
