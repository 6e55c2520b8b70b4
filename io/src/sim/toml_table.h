// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/vec3.h"

namespace surf::io {

/// A table in a TOML file that knows its place. Values are read with their units. Messages name the
/// file, the line and the key. Wrong values are UsageErrors; bad syntax, unknown keys and missing
/// keys are FileErrors.
class TomlTable {
 public:
  static TomlTable parse(std::string_view text, const std::string& file);

  /// Throws at the first key that is not in `known`, and suggests the nearest known key.
  void allow(const std::vector<std::string>& known) const;

  bool has(std::string_view key) const;
  /// All keys, in alphabetical order.
  std::vector<std::string> keys() const;
  bool is_text(std::string_view key) const;
  /// Throws if the key is missing. `why` completes "is missing: ".
  void require(std::string_view key, std::string_view why) const;

  // Empty if the key is missing. Quantities may be numbers in native units or texts with units.
  std::optional<std::string> text(std::string_view key) const;
  std::optional<double> number(std::string_view key) const;
  std::optional<std::int64_t> integer(std::string_view key) const;
  std::optional<bool> flag(std::string_view key) const;
  std::optional<double> length_nm(std::string_view key) const;
  std::optional<double> energy_ev(std::string_view key) const;
  std::optional<double> angle_deg(std::string_view key) const;
  std::optional<double> current_pa(std::string_view key) const;
  std::optional<double> time_us(std::string_view key) const;
  /// The value as texts, one for each element of an array. Numbers are written so that they read
  /// back the same; booleans are "true" and "false". Throws for tables and values that are not
  /// finite.
  std::vector<std::string> words(std::string_view key) const;
  /// An array of texts, or one text; empty if the key is missing.
  std::vector<std::string> texts(std::string_view key) const;
  /// An array of lengths, or a text of lengths separated by `separators`.
  std::optional<std::vector<double>> lengths_nm(std::string_view key,
                                                std::string_view separators = ",") const;
  std::optional<Vec3> point_nm(std::string_view key) const;

  std::optional<TomlTable> table(std::string_view key) const;
  std::vector<TomlTable> tables(std::string_view key) const;

  /// "scene.toml, line 12, beam.energy"; without a key, the table itself.
  std::string place(std::string_view key = {}) const;

 private:
  struct Impl;
  explicit TomlTable(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  std::shared_ptr<const Impl> impl_;
};

}  // namespace surf::io
