// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "sim/toml_table.h"
#include "surf/core/parameters.h"

namespace surf::io {

/// Takes one parameter after the other from the tables of a file: "beam.tilt" from the key tilt of
/// [beam].
class TomlParameters final : public ParameterVisitor {
 public:
  explicit TomlParameters(const TomlTable& root) : root_(root) {}
  void visit(const Parameter& about, Field& field) override;
  bool reads() const override { return true; }

  /// Throws for keys of these tables that no parameter has.
  void refuse_others() const;

 private:
  const TomlTable& root_;
  std::vector<std::pair<std::string, std::vector<std::string>>> known_;  // keys by table
};

/// Runs `work`; what it refuses of a parameter is reported at the parameter's place in the file, if
/// it is there.
void at_parameters(const TomlTable& root, const std::function<void()>& work);

/// All parameters of a struct that the file gives. Throws FileError for keys that are none,
/// UsageError for values, both with line and key.
template <class Struct>
void read_described(const TomlTable& root, Struct& to) {
  at_parameters(root, [&] {
    TomlParameters visitor(root);
    describe(visitor, to);
    visitor.refuse_others();
  });
}

}  // namespace surf::io
