// SPDX-License-Identifier: GPL-3.0-or-later
#include "keywords.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "surf/core/error.h"
#include "surf/core/words.h"

namespace surf::python {
namespace {

/// Parameters whose option is not their last name, as in the command line.
const std::map<std::string, const char*, std::less<>> other_names{
    {"level.method", "level_method"},       {"level.degree", "level_degree"},
    {"level.tolerance", "level_tolerance"}, {"tip.size", "tip_size"},
    {"simulation.detectors", "detector"},
};

bool is_number(FieldKind kind) { return kind == FieldKind::number || kind == FieldKind::whole; }

/// The word between the parts of a text such as "256x192", "1/4" or "0,0,10,10".
char separator_of(const Keyword& keyword) {
  if (keyword.form == "WxH") return 'x';
  return keyword.form == "K/N" ? '/' : ',';
}

std::string text_of(py::handle value, const Keyword& keyword) {
  if (PyUnicode_Check(value.ptr())) return value.cast<std::string>();
  if (PyBool_Check(value.ptr())) return value.ptr() == Py_True ? "on" : "off";
  if (PyLong_Check(value.ptr()) || PyFloat_Check(value.ptr())) return py::str(value);
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  if (py::hasattr(value, "__index__")) return py::str(value.attr("__index__")());
  if (py::hasattr(value, "__float__")) return py::str(value.attr("__float__")());
  throw UsageError("`" + keyword.parameter + "`",
                   fmt::format("an object of the type {} is no value of it",
                               std::string(py::str(py::type::of(value).attr("__name__")))),
                   "Give " + keyword.type());
}

bool is_sequence(py::handle value) {
  return PyList_Check(value.ptr()) || PyTuple_Check(value.ptr()) ||
         (py::hasattr(value, "ndim") && value.attr("ndim").cast<int>() == 1);
}

std::string quoted(const std::string& text) { return py::repr(py::str(text)); }

}  // namespace

std::string keyword_of(std::string_view parameter) {
  const auto found = other_names.find(parameter);
  if (found != other_names.end()) return found->second;
  return std::string(parameter.substr(parameter.rfind('.') + 1));  // npos + 1 is 0
}

std::string with_keywords(std::string_view text) {
  return with_field_words(text, [](std::string_view field, std::string_view value) {
    const std::string name = keyword_of(field);
    return value.empty() ? name : fmt::format("{}='{}'", name, value);
  });
}

Keyword keyword_of(const Parameter& about, const Field& field) {
  Keyword k;
  k.name = keyword_of(about.name);
  k.parameter = about.name;
  k.help = about.help;
  k.unit = unit_suffix(about.unit).empty() ? "" : unit_suffix(about.unit).substr(1);
  k.form = form_of(about, field);
  k.limits = field.kind() == FieldKind::choice ? "" : format_limits(about);
  k.otherwise = about.otherwise;
  k.kind = field.kind();
  k.of = about.unit;
  k.file = about.file;
  k.choices = field.choices();
  k.advanced = about.level == Level::advanced;
  if (!field.given() || !about.otherwise.empty()) return k;
  k.usual = field.text();
  if (k.kind == FieldKind::number && about.unit != Unit::none)
    k.usual = format_value(std::stod(k.usual), about.unit);
  return k;
}

std::string Keyword::type() const {
  switch (kind) {
    case FieldKind::number:
      return of == Unit::none ? "float" : "float | str";
    case FieldKind::whole:
      return "int";
    case FieldKind::flag:
      return "bool";
    case FieldKind::choice: {
      std::vector<std::string> words;
      for (const std::string& choice : choices) words.push_back(quoted(choice));
      return fmt::format("Literal[{}]", fmt::join(words, ", "));
    }
    case FieldKind::list:
      return file != FileRole::none ? "PathLike | Sequence[PathLike]" : "str | float | Sequence";
    case FieldKind::text:
      break;
  }
  if (file != FileRole::none || form == "FOLDER" || form == "FOLDER|off") return "PathLike";
  if (form == "KEY=VALUE,...") return "str | Mapping[str, str]";
  const bool several = form.find(',') != form.npos || form.find("...") != form.npos;
  if (several || form == "WxH" || form == "K/N") return "str | float | Sequence";
  if (form == "LENGTH" || form == "ANGLE" || form == "ENERGY" || form == "NUMBER")
    return "float | str";
  return "str";
}

std::string Keyword::literal() const {
  if (kind == FieldKind::flag) return usual == "on" ? "True" : "False";
  if (usual.empty()) return "None";
  if (is_number(kind) && of == Unit::none) return usual;
  return quoted(usual);
}

std::vector<std::string> texts_of(py::handle value, const Keyword& keyword) {
  if (value.is_none()) return {};
  if (PyDict_Check(value.ptr())) {
    std::vector<std::string> pairs;
    for (const auto& [name, of] : value.cast<py::dict>())
      pairs.push_back(fmt::format("{}={}", text_of(name, keyword), text_of(of, keyword)));
    return {fmt::format("{}", fmt::join(pairs, ","))};
  }
  if (!is_sequence(value)) return {text_of(value, keyword)};
  std::vector<std::string> parts;
  for (const py::handle part : value) parts.push_back(text_of(part, keyword));
  if (keyword.kind == FieldKind::list) return parts;
  return {fmt::format("{}", fmt::join(parts, std::string(1, separator_of(keyword))))};
}

void take(const Parameter& about, Field& field, const GivenTexts& given) {
  const auto found = given.find(about.name);
  if (found == given.end() || found->second.empty()) return;
  if (field.kind() != FieldKind::list) {
    field.read(found->second.back(), about.subject());
    return;
  }
  field.clear();
  for (const std::string& text : found->second) field.add(text, about.subject());
}

}  // namespace surf::python
