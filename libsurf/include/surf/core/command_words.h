// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf {

/// Options that are not called by the last part of their parameter's name: "level.method" is
/// "--level-method".
using OptionNames = std::map<std::string, std::string>;

namespace parameters_detail {
/// The option and its value, of a parameter that is recorded; none where its text is `usual`.
void add_command_words(const Parameter& about, const Field& field, const std::string& usual,
                       const OptionNames& names, std::vector<std::string>& words);
}  // namespace parameters_detail

/// What a command line says to come from `usual` to `of`: option and value of every recorded
/// parameter that differs, the option named by the last part of the parameter's name,
/// "--working-distance".
template <class Struct>
std::vector<std::string> command_words(const Struct& of, const Struct& usual = {},
                                       const OptionNames& names = {}) {
  Struct from = usual, to = of;  // a description may change what it describes
  std::map<std::string, std::string> texts;
  for_each_parameter(
      from, [&](const Parameter& about, Field& field) { texts[about.name] = field.text(); });
  std::vector<std::string> words;
  for_each_parameter(to, [&](const Parameter& about, Field& field) {
    parameters_detail::add_command_words(about, field, texts[about.name], names, words);
  });
  return words;
}

}  // namespace surf
