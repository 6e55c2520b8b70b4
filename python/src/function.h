// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of the module: their arguments, texts and signatures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "keywords.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/reporter.h"

namespace surf::python {

/// An argument that is more than a text: an array, an object of semsurf, a file.
struct Argument {
  std::string name;
  std::string type;  ///< as type checkers read it
  std::string help;  ///< a sentence
  bool required = false;
  bool by_name = true;  ///< false: also by its place
};

struct Function {
  std::string name;
  std::string summary;              ///< one sentence
  std::string details;              ///< further paragraphs, or none
  std::vector<Argument> arguments;  ///< those by place first
  std::vector<Keyword> keywords;
  std::string result_type, result;  ///< type, and a sentence
  std::string example;              ///< lines of Python, or none
  /// The work takes time: `progress` and `threads` are arguments, too.
  bool is_long = true;

  /// Adds the keywords of a struct.
  template <class Struct>
  Function& takes(Struct of = {}, const std::vector<std::string>& without = {}) {
    add_keywords(keywords, std::move(of), without);
    return *this;
  }
};

/// One call of a function, with its arguments sorted.
class Call {
 public:
  /// Throws UsageError for arguments that are unknown, missing or given twice, and for values that
  /// are none.
  Call(const Function& function, const py::args& args, const py::kwargs& keywords);

  /// An argument; None if it is not given.
  py::object operator[](const std::string& argument) const;
  bool has(const std::string& argument) const { return !(*this)[argument].is_none(); }

  /// Gives the struct what keywords say. Throws UsageError that names the parameter.
  template <class Struct>
  void apply(Struct& to) const {
    read_parameters(to, [&](const Parameter& about, Field& field) { take(about, field, given_); });
  }
  template <class Struct>
  Struct told() const {
    Struct to;
    apply(to);
    return to;
  }
  bool is_given(std::string_view parameter) const { return given_.contains(parameter); }
  int threads() const { return told<mc::Execution>().threads; }
  const std::string& name() const { return function_.name; }
  const GivenTexts& given() const { return given_; }
  /// The keyword of that name. Throws UsageError, naming `subject`, for one that is not there.
  const Keyword& keyword(const std::string& name, const std::string& subject) const;

  /// Runs `job` without Python's lock, on a thread of its own, while this one shows its progress
  /// and watches for Ctrl-C. Notes and warnings become Python's. Throws what the job throws; if it
  /// was stopped, semsurf.Interrupted with the attribute `partial`, which `partial` makes where the
  /// job gave a result all the same.
  void work(const std::function<void(const workflow::Reporter&)>& job,
            const std::function<py::object()>& partial = {}) const;

  /// A note for the user, as of a file's unit that was assumed.
  static void note(const std::string& text);
  static void notes(const std::vector<std::string>& texts, const std::string& of = {});
  static void warn(const std::string& text);

 private:
  void set(const std::string& name, py::handle value);

  const Function& function_;
  std::map<std::string, py::object> arguments_;
  GivenTexts given_;
};

using Body = std::function<py::object(const Call& call)>;

/// Adds the function to the module, with a signature and a docstring made of all that is said here.
void define(py::module_& module, Function function, Body body);

/// Whether a function has an argument of that name.
bool is_argument(const std::string& name);

/// Descriptions of all functions, for the stub and for whoever asks: see `semsurf.parameters`.
py::list described_functions();

}  // namespace surf::python
