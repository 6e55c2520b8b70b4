// SPDX-License-Identifier: GPL-3.0-or-later
// Keyword arguments made from descriptions of parameters (surf/core/parameters.h).
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/field_words.h"
#include "surf/core/parameters.h"

namespace surf::python {

namespace py = pybind11;

/// Texts that were given for parameters, by the parameters' names.
using GivenTexts = std::map<std::string, std::vector<std::string>, std::less<>>;

/// A keyword argument that stands for a parameter.
struct Keyword {
  std::string name;       ///< in Python: "working_distance"
  std::string parameter;  ///< "beam.working_distance"
  std::string help, unit, form, limits, otherwise;
  std::string usual;  ///< the default as text; empty: there is none
  FieldKind kind = FieldKind::text;
  Unit of = Unit::none;
  FileRole file = FileRole::none;
  std::vector<std::string> choices;
  bool advanced = false;

  /// The type, as type checkers read it: "float | str".
  std::string type() const;
  /// The default as a Python literal: "'1keV'", "None".
  std::string literal() const;
};

/// The keyword of a parameter: its last name, as the command line has it.
std::string keyword_of(std::string_view parameter);

/// Names fields in messages as keywords: `energy`, or `energy='1keV'` with a value.
std::string with_keywords(std::string_view text);

Keyword keyword_of(const Parameter& about, const Field& field);

/// The keywords of a struct's parameters but for those named `without`.
template <class Struct>
void add_keywords(std::vector<Keyword>& keywords, Struct of = {},
                  const std::vector<std::string>& without = {}) {
  for_each_parameter(of, [&](const Parameter& about, Field& field) {
    if (std::ranges::find(without, about.name) != without.end()) return;
    const Keyword keyword = keyword_of(about, field);
    if (std::ranges::find(keywords, keyword.name, &Keyword::name) == keywords.end())
      keywords.push_back(keyword);
  });
}

/// What a Python value says of a parameter, as texts that `Field` reads. None says nothing. Throws
/// UsageError for objects that are no value.
std::vector<std::string> texts_of(py::handle value, const Keyword& keyword);

/// Gives a field what was given for it.
void take(const Parameter& about, Field& field, const GivenTexts& given);

}  // namespace surf::python
