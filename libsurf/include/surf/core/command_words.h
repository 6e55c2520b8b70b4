// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf {

/// Names of options that differ from the default, by parameter. The default is the last part of the
/// parameter's name. An exception is "level.method", whose option is "--level-method".
using OptionNames = std::map<std::string, std::string>;

namespace parameters_detail {
/// Appends the option and its value to `words`. Appends nothing if the parameter is not recorded,
/// has no value, or its text equals `usual`.
void add_command_words(const Parameter& about, const Field& field, const std::string& usual,
                       const OptionNames& names, std::vector<std::string>& words);
}  // namespace parameters_detail

/// The command-line words that change `usual` into `of`: an option and a value for every recorded
/// parameter that differs. The last part of the parameter's name gives the option:
/// "--working-distance".
template <class Struct>
std::vector<std::string> command_words(const Struct& of, const Struct& usual = {},
                                       const OptionNames& names = {}) {
  Struct from = usual, to = of;  // describe() may change its argument
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
