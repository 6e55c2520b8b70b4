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

// A struct of parameters has a function `describe` that describes each field once: its name, unit,
// range and one sentence of help. Command line, scene files, sweeps, records, checks, ParaView and
// the reference are generated from this description (docs/development/parameters.md). The member
// initialisers of the struct are the only defaults.

/// The unit of a number. Texts may carry a unit ("5mrad"); names of fields and records end in it
/// ("convergence_deg").
enum class Unit { none, share, nm, ev, deg, pa, us, s };

/// "_nm" and so on; empty for plain numbers and shares.
std::string_view unit_suffix(Unit unit);

/// The range of allowed numbers. Infinity and NaN are never allowed.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;  ///< the bound itself is not allowed

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

/// Whether everybody needs a parameter or only experts.
enum class Level { basic, advanced };

/// How a program uses a file that a parameter names. No program writes over a file that it reads.
enum class FileRole { none, read, written, written_folder };

/// The description of a parameter, the same for every interface.
struct Parameter {
  std::string name;  ///< group and name in snake case, without the unit: "beam.working_distance"
  /// A noun phrase or an imperative that makes sense alone, without default and range.
  std::string help;
  Unit unit = Unit::none;
  Limits limits = {};
  /// Describes in words what happens if no value is given, such as "as its file says". Empty: the
  /// default is shown.
  std::string otherwise = {};
  std::string form = {};  ///< syntax of the text, such as "WxH"; empty: derived from kind and unit
  Level level = Level::basic;
  bool recorded = true;            ///< whether the result depends on it
  FileRole file = FileRole::none;  ///< for a parameter that names a file

  /// "working_distance".
  std::string_view last_name() const;
  /// "beam.working_distance_nm": the key in records.
  std::string key() const;
  /// "`beam.working_distance`": the subject of an error (surf/core/field_words.h).
  std::string subject() const;
};

enum class FieldKind { number, whole, flag, choice, text, list };

/// Access to the value of a parameter of any type.
class Field {
 public:
  virtual ~Field() = default;
  virtual FieldKind kind() const = 0;
  /// The allowed words of a choice.
  virtual std::vector<std::string> choices() const { return {}; }
  /// Whether there is a value. False for an optional without value, an empty text and an empty
  /// list.
  virtual bool given() const = 0;
  /// The value as text that `read` converts back exactly, in the native unit; lists are separated
  /// by commas. Empty if there is no value.
  virtual std::string text() const = 0;
  /// Sets the value from text. Throws UsageError naming `subject` if the text is malformed or the
  /// number is out of range.
  virtual void read(std::string_view text, const std::string& subject) = 0;
  /// Appends to a list; for other kinds the same as `read`.
  virtual void add(std::string_view text, const std::string& subject) { read(text, subject); }
  /// Removes the value, if the type permits that.
  virtual void clear() {}
  /// Throws UsageError naming `subject` if the value is not allowed.
  virtual void check(const std::string&) const {}
};

/// Visits each parameter of a struct. The function `describe(ParameterVisitor&, Struct&)` calls the
/// visitor.
class ParameterVisitor {
 public:
  virtual ~ParameterVisitor() = default;

  virtual void visit(const Parameter& about, Field& field) = 0;
  /// Whether the visitor sets values. Mutually exclusive parameters are then presented without
  /// values, so that `describe` can see which of them the visitor has set.
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

  /// A choice; `names` are in the order of the enumeration.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(Enum& value, std::vector<std::string> names, const Parameter& about) {
    int index = static_cast<int>(value);
    choice(index, std::move(names), about);
    value = static_cast<Enum>(index);
  }
  /// An optional choice. `none` is the word for no choice, or empty if there is no such word.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(std::optional<Enum>& value, std::vector<std::string> names,
                  const Parameter& about, const char* none = "") {
    int index = value ? static_cast<int>(*value) : -1;
    optional_choice(index, std::move(names), about, none);
    if (index < 0) value.reset();
    else value = static_cast<Enum>(index);
  }

  /// A parameter with a syntax of its own. `write` returns an empty text for no value. `read`
  /// throws UsageError naming the subject.
  void form(const Parameter& about, std::function<std::string()> write,
            std::function<void(std::string_view text, const std::string& subject)> read,
            FieldKind kind = FieldKind::text);

 private:
  void choice(int& index, std::vector<std::string> names, const Parameter& about);
  void optional_choice(int& index, std::vector<std::string> names, const Parameter& about,
                       const char* none);
};

/// Converts a number with unit to the parameter's unit and checks the limits. Errors name
/// `subject`.
double parse_value(std::string_view text, const Parameter& about, const std::string& subject);

/// Formats a value for people: "1keV", "0.002", "30deg".
std::string format_value(double value, Unit unit);

/// Describes the limits: "100eV to 30keV", "below 90deg". Empty if every number is allowed.
std::string format_limits(const Parameter& about);

/// The placeholder for the value in help texts: "LENGTH", "N", "on|off", "mirror|flat|periodic".
std::string form_of(const Parameter& about, const Field& field);

/// Keys and values of all recorded parameters that have a value.
using Record = std::map<std::string, std::string>;

// The following templates work for every struct with a `describe` function.

namespace parameters_detail {
/// A visitor that calls a function.
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

/// As `for_each_parameter`, for functions that set values.
template <class Struct>
void read_parameters(Struct& to, std::function<void(const Parameter&, Field&)> call) {
  parameters_detail::Calling visitor(std::move(call), true);
  describe(visitor, to);
}

/// Throws UsageError naming the first field whose value is not allowed.
template <class Struct>
void check_parameters(const Struct& of) {
  Struct copy = of;  // describe() may change its argument
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

/// Sets one parameter from text. Throws std::invalid_argument if there is no parameter `name`,
/// UsageError if its value is not allowed.
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
