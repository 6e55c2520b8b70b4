// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/parameters.h"

namespace surf {

/// A parameter that one struct takes over from another. Empty members keep the other struct's text.
struct SomeParameter {
  std::string name;  ///< as in the other struct
  std::string help = {};
  std::string otherwise = {};
};

/// Visits the parameters in `some`, in the order of `describe`. For structs that use only a part of
/// another struct.
template <class Struct>
void describe_some(ParameterVisitor& visit, Struct& of, const std::vector<SomeParameter>& some) {
  const auto show = [&](const Parameter& about, Field& field) {
    for (const SomeParameter& one : some) {
      if (one.name != about.name) continue;
      Parameter told = about;
      if (!one.help.empty()) told.help = one.help;
      if (!one.otherwise.empty()) told.otherwise = one.otherwise;
      visit.visit(told, field);
    }
  };
  parameters_detail::Calling shown(show, visit.reads());
  describe(shown, of);
}

/// Parses "24,12" as whole numbers, each within the limits of `about`. Throws UsageError naming
/// `subject`.
std::vector<int> parse_whole_numbers(std::string_view text, const Parameter& about,
                                     const std::string& subject);

/// Parses "X,Y" as lengths, angles and so on, according to the unit of `about`: n commas separate n
/// + 1 numbers. Throws UsageError naming `subject`.
std::vector<double> parse_values(std::string_view text, const Parameter& about,
                                 const std::string& subject);

}  // namespace surf
