// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace surf {

// A struct of parameters says of each field once what it is: its name, unit, range and one
// sentence. Command line, scene files, sweeps, records, checks, ParaView and the reference are made
// from that (docs/development/parameters.md). The member initialisers of the struct are the only
// defaults.

/// What a number counts. Texts may carry it ("5mrad"); names of fields and records end in it
/// ("convergence_deg").
enum class Unit { none, share, nm, ev, deg, pa, us, s };

/// "_nm" and so on; empty for plain numbers and shares.
std::string_view unit_suffix(Unit unit);

/// Which numbers are allowed. Infinity and NaN never are.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;  ///< the end itself is not allowed

  bool holds(double value) const;
};

constexpr Limits within(double low, double high) { return {low, high, false, false}; }
constexpr Limits from_to_below(double low, double high) { return {low, high, false, true}; }
constexpr Limits above(double low, double high = std::numeric_limits<double>::infinity()) {
  return {low, high, true, false};
}
constexpr Limits at_least(double low) {
  return {low, std::numeric_limits<double>::infinity(), false, false};
}

/// Who needs it: everybody, or those who know what they do.
enum class Level { basic, advanced };

/// What is done with a file that a parameter names: nothing is written over what is read.
enum class FileRole { none, read, written, written_folder };

/// What is true of a parameter wherever it is met.
struct Parameter {
  std::string name;  ///< group and name, in snake case without unit: "beam.working_distance"
  std::string
      help;  ///< a noun phrase or an imperative that makes sense alone, without default and range
  Unit unit = Unit::none;
  Limits limits = {};
  std::string otherwise =
      {};  ///< what holds where nothing is given, in words: "as its file says"; else the default
  std::string form = {};  ///< how its text is written, "WxH"; empty: by its kind and unit
  Level level = Level::basic;
  bool recorded = true;            ///< whether the result depends on it
  FileRole file = FileRole::none;  ///< of a parameter that names a file

  /// "working_distance".
  std::string_view last_name() const;
  /// "beam.working_distance_nm": the key in records.
  std::string key() const;
  /// "`beam.working_distance`": the subject of an error (surf/core/field_words.h).
  std::string subject() const;
};

enum class FieldKind { number, whole, flag, choice, text, list };

/// The value of a parameter, whatever its type.
class Field {
 public:
  virtual ~Field() = default;
  virtual FieldKind kind() const = 0;
  /// Words that may stand for it, of a choice.
  virtual std::vector<std::string> choices() const { return {}; }
  /// Whether there is a value: false for an optional without one, an empty text or list.
  virtual bool given() const = 0;
  /// The value as `read` reads it back exactly, in the native unit; of a list, with commas. Empty
  /// where it is not given.
  virtual std::string text() const = 0;
  /// Takes the value from text. Throws UsageError that names `subject`, also for numbers out of
  /// range.
  virtual void read(std::string_view text, const std::string& subject) = 0;
  /// One more of a list; else as `read`.
  virtual void add(std::string_view text, const std::string& subject) { read(text, subject); }
  /// Back to nothing, where that is possible.
  virtual void clear() {}
  /// Throws UsageError that names `subject` where the value is not allowed.
  virtual void check(const std::string&) const {}
};

/// Is shown each parameter of a struct by its function `describe(ParameterVisitor&, Struct&)`.
class ParameterVisitor {
 public:
  virtual ~ParameterVisitor() = default;

  virtual void visit(const Parameter& about, Field& field) = 0;
  /// Whether it gives values: what is one of several ways then shows none of them, so that those
  /// given can be told.
  virtual bool reads() const { return false; }

  void operator()(double& value, const Parameter& about);
  void operator()(int& value, const Parameter& about);
  void operator()(std::int64_t& value, const Parameter& about);
  void operator()(std::uint64_t& value, const Parameter& about);
  void operator()(bool& value, const Parameter& about);
  void operator()(std::string& value, const Parameter& about);
  void operator()(std::vector<std::string>& value, const Parameter& about);
  void operator()(std::optional<double>& value, const Parameter& about);
  void operator()(std::optional<int>& value, const Parameter& about);
  void operator()(std::optional<std::int64_t>& value, const Parameter& about);
  void operator()(std::optional<std::string>& value, const Parameter& about);

  /// One of several words; `names` in the order of the enumeration.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(Enum& value, std::vector<std::string> names, const Parameter& about) {
    int index = static_cast<int>(value);
    choice(index, std::move(names), about);
    value = static_cast<Enum>(index);
  }
  /// The same, or none of them: `none` is the word for that, or empty where there is no word.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(std::optional<Enum>& value, std::vector<std::string> names,
                  const Parameter& about, const char* none = "") {
    int index = value ? static_cast<int>(*value) : -1;
    optional_choice(index, std::move(names), about, none);
    if (index < 0) value.reset();
    else value = static_cast<Enum>(index);
  }

  /// What has a form of its own: `write` gives an empty text for nothing, `read` throws UsageError
  /// naming the subject.
  void form(const Parameter& about, std::function<std::string()> write,
            std::function<void(std::string_view text, const std::string& subject)> read,
            FieldKind kind = FieldKind::text);

 private:
  void choice(int& index, std::vector<std::string> names, const Parameter& about);
  void optional_choice(int& index, std::vector<std::string> names, const Parameter& about,
                       const char* none);
};

/// A number as text to the parameter's unit; names `subject` in what it throws. The limits are
/// checked.
double parse_value(std::string_view text, const Parameter& about, const std::string& subject);

/// "1keV", "0.002", "30deg": for people.
std::string format_value(double value, Unit unit);

/// "100eV to 30keV", "below 90deg"; empty where everything is allowed.
std::string format_limits(const Parameter& about);

/// "LENGTH", "N", "on|off", "mirror|flat|periodic": what stands for its value in help.
std::string form_of(const Parameter& about, const Field& field);

/// Keys and values of all recorded parameters that are given.
using Record = std::map<std::string, std::string>;

// For any struct that is described.

namespace parameters_detail {
/// `visit` with a function.
class Calling final : public ParameterVisitor {
 public:
  Calling(std::function<void(const Parameter&, Field&)> call, bool reads)
      : call_(std::move(call)), reads_(reads) {}
  void visit(const Parameter& about, Field& field) override { call_(about, field); }
  bool reads() const override { return reads_; }

 private:
  std::function<void(const Parameter&, Field&)> call_;
  bool reads_;
};
void check_field(const Parameter& about, Field& field);
void record_field(const Parameter& about, Field& field, Record& record);
}  // namespace parameters_detail

template <class Struct>
void for_each_parameter(Struct& of, std::function<void(const Parameter&, Field&)> call) {
  parameters_detail::Calling visitor(std::move(call), false);
  describe(visitor, of);
}

/// The same for who gives values.
template <class Struct>
void read_parameters(Struct& to, std::function<void(const Parameter&, Field&)> call) {
  parameters_detail::Calling visitor(std::move(call), true);
  describe(visitor, to);
}

/// Throws UsageError that names the field for the first value that is not allowed.
template <class Struct>
void check_parameters(const Struct& of) {
  Struct copy = of;  // a description may change what it describes
  for_each_parameter(copy, parameters_detail::check_field);
}

template <class Struct>
Record record_of(const Struct& of) {
  Struct copy = of;
  Record record;
  for_each_parameter(copy, [&](const Parameter& about, Field& field) {
    parameters_detail::record_field(about, field, record);
  });
  return record;
}

/// Sets one parameter from text. Throws UsageError where there is none of that name, or its value
/// is not allowed.
template <class Struct>
void set_parameter(Struct& of, std::string_view name, std::string_view text) {
  bool found = false;
  read_parameters(of, [&](const Parameter& about, Field& field) {
    if (about.name != name) return;
    found = true;
    field.read(text, about.subject());
  });
  if (!found) throw std::invalid_argument("no parameter " + std::string(name));
}

}  // namespace surf
