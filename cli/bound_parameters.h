// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the command line made from descriptions of parameters (surf/core/parameters.h).
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/parameters.h"

namespace surf::cli {

/// Texts that were given for parameters, by the parameters' names. A flag's is "on".
using GivenTexts = std::map<std::string, std::vector<std::string>, std::less<>>;

/// How a command names and shows a parameter, where it is not as usual.
struct OptionLook {
  std::string name;  ///< "-o,--output"; empty: the parameter's last name, "--working-distance"
  std::vector<std::string> former;  ///< hidden names from before: "--pitch"
  std::string help;                 ///< empty: the description's
  bool positional = false;          ///< `name` is what stands for it in help, "INPUT"
  bool hidden = false;              ///< not in this command
};

/// Looks by parameter name.
using OptionLooks = std::map<std::string, OptionLook, std::less<>>;

/// The options of one command that stand for parameters of structs. What was given is kept as text
/// until `apply`.
class BoundParameters {
 public:
  /// Declares an option for each parameter of the struct that is described; defaults in help are
  /// those of `of`. With `only`, those parameters alone.
  template <class Struct>
  void add(CLI::App& app, const std::string& group, Struct of = {},
           const std::vector<std::string>& only = {}) {
    for_each_parameter(
        of, [&](const Parameter& about, Field& field) { declare(app, group, about, field, only); });
  }

  /// Before `add`: how these are named and shown.
  OptionLooks looks;
  /// Headings in help by the parameter's name, or by its group ("beam"): for parameters that are
  /// added without one.
  std::map<std::string, std::string, std::less<>> headings;

  /// Gives the struct what was given. Throws UsageError that names the parameter.
  template <class Struct>
  void apply(Struct& to) const {
    apply(to, *given_);
  }
  template <class Struct>
  static void apply(Struct& to, const GivenTexts& given) {
    read_parameters(to, [&](const Parameter& about, Field& field) { take(about, field, given); });
  }

  /// Of an option that the command reads by itself: messages about the parameter name it
  /// (`option_of`).
  void stands_for(const CLI::Option* option, const std::string& parameter);

  const GivenTexts& given() const { return *given_; }
  bool is_given(std::string_view name) const { return given_->contains(name); }

 private:
  void declare(CLI::App& app, const std::string& group, const Parameter& about, const Field& field,
               const std::vector<std::string>& only);
  static void take(const Parameter& about, Field& field, const GivenTexts& given);

  std::shared_ptr<GivenTexts> given_ = std::make_shared<GivenTexts>();
};

/// "--working-distance" of "beam.working_distance".
std::string option_name(std::string_view parameter);

/// The option that stands for a parameter in a command; empty where there is none.
std::string option_of(const CLI::App& command, std::string_view parameter);

/// What is done with the file that an option names; empty where nothing is known of it.
std::optional<FileRole> file_role(const CLI::Option& option);

/// A list of texts with commas in them, one for each time that its option is given.
void describe_texts(ParameterVisitor& visit, std::vector<std::string>& texts,
                    const Parameter& about);

/// Whether help says the value that the field has by default, and no words in its place.
bool shows_default(const CLI::Option& option);

/// Says it of an option that a command declares and reads by itself. Every option of a file or
/// folder needs that.
CLI::Option* with_role(CLI::Option* option, FileRole role);

}  // namespace surf::cli
