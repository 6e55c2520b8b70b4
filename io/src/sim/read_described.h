// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "sim/toml_table.h"
#include "surf/core/parameters.h"

namespace surf::io {

/// Sets parameters from the tables of a file: "beam.tilt" from the key tilt of [beam].
class TomlParameters final : public ParameterVisitor {
 public:
  explicit TomlParameters(const TomlTable& root) : root_(root) {}
  void visit(const Parameter& about, Field& field) override;
  bool reads() const override { return true; }

  /// Throws for keys in these tables that belong to no parameter.
  void refuse_others() const;

 private:
  const TomlTable& root_;
  std::vector<std::pair<std::string, std::vector<std::string>>> known_;  // known keys by table
};

/// Runs `work`. An error about a parameter is reported at the parameter's place in the file, if it
/// has one.
void at_parameters(const TomlTable& root, const std::function<void()>& work);

/// Reads all parameters of a struct that the file gives. Throws FileError for unknown keys,
/// UsageError for wrong values, both with line and key.
template <class Struct>
void read_described(const TomlTable& root, Struct& to) {
  at_parameters(root, [&] {
    TomlParameters visitor(root);
    describe(visitor, to);
    visitor.refuse_others();
  });
}

}  // namespace surf::io
