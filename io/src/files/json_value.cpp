// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_value.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "damaged.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

// The library's messages begin with "[json.exception.parse_error.101] ".
std::string without_code(std::string message) {
  const auto end = message.find("] ");
  return message.starts_with("[json.") && end != std::string::npos ? message.substr(end + 2)
                                                                   : message;
}

}  // namespace

JsonValue JsonValue::parse(const std::string& file, std::string_view text) {
  std::shared_ptr<const nlohmann::json> root;
  try {
    root = std::make_shared<const nlohmann::json>(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw FileError(file, fmt::format("its JSON is broken: {}", without_code(error.what())),
                    copy_again);
  }
  const JsonValue value(root, root.get(), file);
  if (!root->is_object()) value.fail("its JSON is not an object");
  return value;
}

JsonValue JsonValue::at(const nlohmann::json& value, std::string_view step) const {
  const char* const joint = value_ != root_.get() || step.starts_with('[') ? "" : ", ";
  const bool needs_dot = value_ != root_.get() && !step.starts_with('[');
  return {root_, &value, fmt::format("{}{}{}{}", place_, joint, needs_dot ? "." : "", step)};
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
  if (!value_->is_object()) fail(fmt::format("an object is expected, not {}", value_->type_name()));
  const auto found = value_->find(key);
  if (found == value_->end()) return {};
  return at(*found, key);
}

JsonValue JsonValue::require(const std::string& key) const {
  const auto value = find(key);
  if (!value) fail(fmt::format("'{}' is missing", key));
  return *value;
}

const nlohmann::json* JsonValue::array(const std::string& key) const {
  const auto value = find(key);
  if (!value) return nullptr;
  if (!value->value_->is_array()) {
    value->fail(fmt::format("an array is expected, not {}", value->value_->type_name()));
  }
  return value->value_;
}

std::size_t JsonValue::count(const std::string& key) const {
  const nlohmann::json* const values = array(key);
  return values ? values->size() : 0;
}

std::vector<JsonValue> JsonValue::items(const std::string& key) const {
  std::vector<JsonValue> result;
  const std::size_t size = count(key);
  result.reserve(size);
  for (std::size_t i = 0; i < size; ++i) result.push_back(item(key, i));
  return result;
}

JsonValue JsonValue::item(const std::string& key, std::uint64_t index) const {
  const nlohmann::json* const values = array(key);
  const std::size_t size = values ? values->size() : 0;
  if (index >= size) {
    fail(fmt::format("{}[{}] is named, but there are {}", key, index, size));
  }
  return at((*values)[index], fmt::format("{}[{}]", key, index));
}

bool JsonValue::is_object() const { return value_->is_object(); }

bool JsonValue::is_text() const { return value_->is_string(); }

std::vector<std::string> JsonValue::keys() const {
  if (!value_->is_object()) fail(fmt::format("an object is expected, not {}", value_->type_name()));
  std::vector<std::string> keys;
  for (const auto& [key, value] : value_->items()) keys.push_back(key);
  return keys;
}

std::vector<double> JsonValue::numbers(const std::string& key) const {
  std::vector<double> numbers;
  const nlohmann::json* const values = array(key);
  if (!values) return numbers;
  numbers.reserve(values->size());
  for (std::size_t i = 0; i < values->size(); ++i) {
    const double value = (*values)[i].is_number() ? (*values)[i].get<double>() : NAN;
    if (!std::isfinite(value)) fail(fmt::format("{}[{}]: a finite number is expected", key, i));
    numbers.push_back(value);
  }
  return numbers;
}

std::map<std::string, std::string> JsonValue::texts(const std::string& key) const {
  std::map<std::string, std::string> texts;
  const auto object = find(key);
  if (!object) return texts;
  if (!object->is_object()) object->fail("an object is expected");
  for (const auto& [name, value] : object->value_->items())
    texts[name] = object->at(value, name).text();
  return texts;
}

double JsonValue::number() const {
  const double value = value_->is_number() ? value_->get<double>() : NAN;
  if (!std::isfinite(value)) fail("a finite number is expected");
  return value;
}

std::uint64_t JsonValue::whole() const {
  // Some exporters write 3.0 for 3.
  const double value = value_->is_number() ? value_->get<double>() : -1;
  if (!(value >= 0 && value <= 0x1p53 && value == std::floor(value))) {
    fail("a whole number, 0 or above, is expected");
  }
  return static_cast<std::uint64_t>(value);
}

std::string JsonValue::text() const {
  if (!value_->is_string()) fail("a text is expected");
  return value_->get<std::string>();
}

bool JsonValue::boolean() const {
  if (!value_->is_boolean()) fail("true or false is expected");
  return value_->get<bool>();
}

std::uint64_t JsonValue::whole(const std::string& key, std::uint64_t fallback) const {
  const auto value = find(key);
  return value ? value->whole() : fallback;
}

std::string JsonValue::text(const std::string& key, const std::string& fallback) const {
  const auto value = find(key);
  return value ? value->text() : fallback;
}

bool JsonValue::boolean(const std::string& key, bool fallback) const {
  const auto value = find(key);
  return value ? value->boolean() : fallback;
}

void JsonValue::fail(const std::string& reason, const std::string& remedy) const {
  throw FileError(place_, reason, remedy.empty() ? "Repair the file or export it again" : remedy);
}

}  // namespace surf::io
