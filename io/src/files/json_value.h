// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// A value in a JSON file that knows its place. Every error is a FileError that names file and
/// place, as "part.gltf, nodes[3].scale". Copies share the parsed text.
class JsonValue {
 public:
  /// Parses the whole text, which must be one object. Nesting may have any depth.
  static JsonValue parse(const std::string& file, std::string_view text);

  /// The value of a key of this object, if the key exists.
  std::optional<JsonValue> find(const std::string& key) const;
  /// The value of a key of this object. Throws if the key is missing.
  JsonValue require(const std::string& key) const;

  /// The items of the array at `key`; empty if the key is missing.
  std::vector<JsonValue> items(const std::string& key) const;
  /// The item with number `index` in the array at `key`.
  JsonValue item(const std::string& key, std::uint64_t index) const;
  std::size_t count(const std::string& key) const;

  bool is_object() const;
  bool is_text() const;
  /// The keys of this object, in alphabetical order.
  std::vector<std::string> keys() const;

  /// The finite numbers of the array at `key`; empty if the key is missing.
  std::vector<double> numbers(const std::string& key) const;
  /// The texts of the object at `key`, by their keys; empty if the key is missing.
  std::map<std::string, std::string> texts(const std::string& key) const;

  double number() const;
  /// A whole number from 0 to 2^53.
  std::uint64_t whole() const;
  std::string text() const;
  bool boolean() const;

  // The value of a key, or the fallback if the key is missing.
  std::uint64_t whole(const std::string& key, std::uint64_t fallback) const;
  std::string text(const std::string& key, const std::string& fallback) const;
  bool boolean(const std::string& key, bool fallback) const;

  const std::string& place() const { return place_; }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = {}) const;

 private:
  JsonValue(std::shared_ptr<const nlohmann::json> root, const nlohmann::json* value,
            std::string place)
      : root_(std::move(root)), value_(value), place_(std::move(place)) {}

  JsonValue at(const nlohmann::json& value, std::string_view step) const;
  const nlohmann::json* array(const std::string& key) const;

  std::shared_ptr<const nlohmann::json> root_;
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace surf::io
