// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf::pv {

/// What the properties of a proxy say, by the names of the parameters that they stand for.
class PropertyValues {
 public:
  // Each returns whether that is something new. A name may carry what says nothing:
  // "beam.current=0".
  bool set(const char* name, const char* text);
  bool set(const char* name, double value);
  bool set(const char* name, const std::vector<double>& values);

  /// The text of one; empty where nothing was said.
  std::string text(const std::string& name) const;
  /// The number of one; 0 where nothing was said.
  double number(const std::string& name) const;
  /// As if nothing had been said of it.
  void forget(const std::string& name) { texts_.erase(name); }

  /// Gives the struct what was said: of a choice its number. Empty texts say nothing. Throws
  /// UsageError that names the parameter.
  template <class Struct>
  void apply(Struct& to) const {
    read_parameters(to, [&](const Parameter& about, Field& field) { take(about, field); });
  }
  /// The same of some parameters.
  template <class Struct>
  void apply(Struct& to, const std::vector<std::string>& only) const {
    read_parameters(to, [&](const Parameter& about, Field& field) {
      if (std::ranges::find(only, about.name) != only.end()) take(about, field);
    });
  }

  /// All of it, to see whether anything has changed.
  std::string all() const;

 private:
  void take(const Parameter& about, Field& field) const;

  bool keep(const std::string& name, std::string text);

  std::map<std::string, std::string> texts_;
};

}  // namespace surf::pv
