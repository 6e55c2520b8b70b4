// SPDX-License-Identifier: GPL-3.0-or-later
#include "function.h"

#include <fmt/format.h>

#include <deque>
#include <memory>

#include "surf/core/error.h"
#include "surf/core/words.h"

namespace surf::python {
namespace {

/// Functions stay where they are: what is defined refers to them.
std::deque<Function>& functions() {
  static std::deque<Function> all;
  return all;
}

const Argument progress{"progress", "bool | Callable[[float, float, str], object]",
                        "True shows a bar; a function is called with what is done, the total, and "
                        "what is counted."};

std::string signature_of(const Function& f) {
  std::string text = f.name + "(";
  bool first = true, named = false;
  const auto add = [&](const std::string& one) {
    text += (first ? "" : ", ") + one;
    first = false;
  };
  for (const Argument& a : f.arguments) {
    if (a.by_name && !named) add("*"), named = true;
    add(a.required ? a.name : a.name + "=None");
  }
  if (!named && !f.keywords.empty()) add("*");
  for (const Keyword& k : f.keywords) add(k.name + "=" + k.literal());
  return text + ")";
}

/// Breaks between words, indented.
std::string wrapped(const std::string& text, const std::string& indent) {
  constexpr std::size_t width = 79;
  std::string out, line = indent;
  for (const std::string_view word : split(text, " ")) {
    if (line.size() + 1 + word.size() > width && line.size() > indent.size()) {
      out += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + std::string(word);
  }
  return out + line + "\n";
}

/// "eV, or text with a unit".
std::string kind_in_words(const Keyword& k) {
  if (k.kind == FieldKind::number && !k.unit.empty()) return k.unit + ", or text with a unit";
  if (k.kind == FieldKind::choice) return k.type().substr(7);
  return k.type();
}

std::string help_of(const Keyword& k) {
  std::string text = kind_in_words(k);
  if (!k.otherwise.empty()) text += " (" + with_keywords(k.otherwise) + ")";
  else if (k.kind != FieldKind::flag && !k.usual.empty()) text += ", default " + k.literal();
  std::string help = with_keywords(k.help);
  if (!k.limits.empty()) help += ", " + k.limits;
  if (k.kind == FieldKind::text && k.type().find("Sequence") != std::string::npos)
    help += "; written " + k.form;
  return fmt::format("{} : {}\n{}", k.name, text, wrapped(help + ".", "    "));
}

std::string docstring_of(const Function& f) {
  std::string text = signature_of(f) + "\n--\n\n" + f.summary + "\n\n";
  if (!f.details.empty()) text += f.details + "\n\n";
  text += "Parameters\n----------\n";
  for (const Argument& a : f.arguments)
    text += fmt::format("{} : {}\n{}", a.name, a.type, wrapped(a.help, "    "));
  for (const Keyword& k : f.keywords) text += help_of(k);
  text += fmt::format("\nReturns\n-------\n{}\n{}", f.result_type, wrapped(f.result, "    "));
  if (!f.example.empty()) text += "\nExamples\n--------\n" + f.example + "\n";
  return text;
}

/// The keyword or argument that is nearest to a wrong one.
std::string nearest(const Function& f, const std::string& name) {
  std::string best;
  std::size_t least = std::max<std::size_t>(3, name.size() / 3);
  const auto look = [&](const std::string& known) {
    const std::size_t distance = edit_distance(name, known);
    if (distance < least) least = distance, best = known;
  };
  for (const Argument& a : f.arguments) look(a.name);
  for (const Keyword& k : f.keywords) look(k.name);
  return best;
}

py::dict described(const Keyword& k) {
  py::dict d;
  d["name"] = k.name;
  d["parameter"] = k.parameter;
  d["help"] = with_keywords(k.help);
  d["type"] = k.type();
  d["default"] = k.literal();
  d["otherwise"] = with_keywords(k.otherwise);
  d["unit"] = k.unit;
  d["form"] = k.form;
  d["range"] = k.limits;
  py::list choices;
  for (const std::string& choice : k.choices) choices.append(choice);
  d["choices"] = choices;
  d["advanced"] = k.advanced;
  return d;
}

py::dict described(const Argument& a) {
  py::dict d;
  d["name"] = a.name;
  d["type"] = a.type;
  d["help"] = a.help;
  d["required"] = a.required;
  d["by_name"] = a.by_name;
  return d;
}

}  // namespace

Call::Call(const Function& function, const py::args& args, const py::kwargs& keywords)
    : function_(function) {
  std::size_t place = 0;
  for (const py::handle value : args) {
    if (place >= function.arguments.size() || function.arguments[place].by_name)
      throw UsageError(function.name, fmt::format("it takes {} arguments by place", place),
                       "Name the others, as progress=True");
    set(function.arguments[place++].name, value);
  }
  for (const auto& [name, value] : keywords) set(name.cast<std::string>(), value);
  for (const Argument& a : function.arguments)
    if (a.required && !has(a.name))
      throw UsageError(a.name, fmt::format("{} needs it", function.name), "Give " + a.type);
}

void Call::set(const std::string& name, py::handle value) {
  for (const Argument& a : function_.arguments) {
    if (a.name != name) continue;
    if (!arguments_.emplace(name, py::reinterpret_borrow<py::object>(value)).second)
      throw UsageError(name, "it is given twice", "Leave one of them out");
    return;
  }
  for (const Keyword& k : function_.keywords) {
    if (k.name != name) continue;
    std::vector<std::string> texts = texts_of(value, k);
    if (!texts.empty()) given_[k.parameter] = std::move(texts);
    return;
  }
  const std::string near = nearest(function_, name);
  throw UsageError(name, fmt::format("{} has no such argument", function_.name),
                   near.empty() ? fmt::format("help(semsurf.{}) lists them", function_.name)
                                : fmt::format("Is {} meant?", near));
}

const Keyword& Call::keyword(const std::string& name, const std::string& subject) const {
  for (const Keyword& k : function_.keywords)
    if (k.name == name) return k;
  const std::string near = nearest(function_, name);
  throw UsageError(subject, fmt::format("{} has no argument '{}'", function_.name, name),
                   near.empty() ? fmt::format("help(semsurf.{}) lists them", function_.name)
                                : fmt::format("Is {} meant?", near));
}

py::object Call::operator[](const std::string& argument) const {
  const auto found = arguments_.find(argument);
  return found == arguments_.end() ? py::object(py::none()) : found->second;
}

void define(py::module_& module, Function function, Body body) {
  if (function.is_long) {
    function.takes<mc::Execution>();
    function.arguments.push_back(progress);
  }
  functions().push_back(std::move(function));
  const Function& f = functions().back();
  py::options options;
  options.disable_function_signatures();
  module.def(
      f.name.c_str(),
      [&f, body = std::move(body)](const py::args& args, const py::kwargs& keywords) {
        return body(Call(f, args, keywords));
      },
      docstring_of(f).c_str());
}

bool is_argument(const std::string& name) {
  if (name == progress.name) return true;
  for (const Function& f : functions())
    for (const Argument& a : f.arguments)
      if (a.name == name) return true;
  return false;
}

py::list described_functions() {
  py::list all;
  for (const Function& f : functions()) {
    py::dict d;
    d["name"] = f.name;
    d["summary"] = f.summary;
    py::list arguments, keywords;
    for (const Argument& a : f.arguments) arguments.append(described(a));
    for (const Keyword& k : f.keywords) keywords.append(described(k));
    d["arguments"] = arguments;
    d["keywords"] = keywords;
    d["result"] = f.result_type;
    all.append(d);
  }
  return all;
}

}  // namespace surf::python
