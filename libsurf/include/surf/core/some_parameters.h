// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/parameters.h"

namespace surf {

/// One of the parameters of a struct, as part of another: empty members are as the struct describes
/// them.
struct SomeParameter {
  std::string name;  ///< as the struct describes it
  std::string help = {};
  std::string otherwise = {};
};

/// Shows some parameters of a struct, in the struct's own order: for structs that use only these of
/// it.
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

/// "24,12" as whole numbers, each as `about` allows. Throws UsageError naming `subject`.
std::vector<int> parse_whole_numbers(std::string_view text, const Parameter& about,
                                     const std::string& subject);

/// "X,Y" of lengths, angles and so on: as many numbers as there are commas and one. Throws
/// UsageError naming `subject`.
std::vector<double> parse_values(std::string_view text, const Parameter& about,
                                 const std::string& subject);

}  // namespace surf
