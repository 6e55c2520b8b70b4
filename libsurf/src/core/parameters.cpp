// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

constexpr double most_exact = 9007199254740992.0;  // 2^53

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

template <class T>
bool read_all(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

const char* thing(Unit unit, bool whole) {
  switch (unit) {
    case Unit::none:
      return whole ? "a whole number" : "a number";
    case Unit::share:
      return "a share";
    case Unit::nm:
      return "a length";
    case Unit::ev:
      return "an energy";
    case Unit::deg:
      return "an angle";
    case Unit::pa:
      return "a current";
    case Unit::us:
    case Unit::s:
      return "a time";
  }
  return "a value";
}

[[noreturn]] void refuse_value(const std::string& shown, const Parameter& about,
                               const std::string& subject, bool whole) {
  const std::string limits = format_limits(about);
  throw UsageError(subject, fmt::format("{} is out of range", shown),
                   fmt::format("Give {} {}", thing(about.unit, whole),
                               limits.empty() ? "that is finite" : limits));
}

void check_number(double value, const Parameter& about, const std::string& subject,
                  bool whole = false) {
  if (!about.limits.holds(value))
    refuse_value(format_value(value, about.unit), about, subject, whole);
}

/// Converts between a value of type T and its text.
template <class T>
struct Reading;

template <>
struct Reading<double> {
  static constexpr FieldKind kind = FieldKind::number;
  static std::string text(double value) { return format_exact(value); }
  static double read(std::string_view text, const Parameter& about, const std::string& subject) {
    return parse_value(text, about, subject);
  }
  static void check(double value, const Parameter& about, const std::string& subject) {
    check_number(value, about, subject);
  }
};

template <class Whole>
struct ReadingWhole {
  static constexpr FieldKind kind = FieldKind::whole;
  static std::string text(Whole value) { return std::to_string(value); }
  static Whole read(std::string_view text, const Parameter& about, const std::string& subject) {
    text = trimmed(text);
    Whole value = 0;
    if (!read_all(text, value)) {
      double real = 0;  // "1e6" is a whole number, too
      if (!read_all(text, real) || !std::isfinite(real) || real != std::floor(real))
        throw UsageError(
            subject, fmt::format("'{}' is not a whole number", text),
            fmt::format("Give a whole number{}{}", format_limits(about).empty() ? "" : " ",
                        format_limits(about)));
      const double lowest = static_cast<double>(std::numeric_limits<Whole>::min());
      const double highest =
          std::min(most_exact, static_cast<double>(std::numeric_limits<Whole>::max()));
      if (real < lowest || real > highest) {
        Parameter of_type = about;  // the limits of the type, if the parameter has none
        if (format_limits(about).empty())
          of_type.limits = within(lowest, static_cast<double>(std::numeric_limits<Whole>::max()));
        refuse_value(fmt::format("'{}'", text), of_type, subject, true);
      }
      value = static_cast<Whole>(real);
    }
    if (!about.limits.holds(static_cast<double>(value)))
      refuse_value(fmt::format("'{}'", text), about, subject, true);
    return value;
  }
  static void check(Whole value, const Parameter& about, const std::string& subject) {
    check_number(static_cast<double>(value), about, subject, true);
  }
};

template <>
struct Reading<int> : ReadingWhole<int> {};
template <>
struct Reading<std::int64_t> : ReadingWhole<std::int64_t> {};
template <>
struct Reading<std::uint64_t> : ReadingWhole<std::uint64_t> {};

template <>
struct Reading<bool> {
  static constexpr FieldKind kind = FieldKind::flag;
  static std::string text(bool value) { return value ? "on" : "off"; }
  static bool read(std::string_view text, const Parameter&, const std::string& subject) {
    for (const char* yes : {"on", "true", "yes", "1"})
      if (text == yes) return true;
    for (const char* no : {"off", "false", "no", "0"})
      if (text == no) return false;
    throw UsageError(subject, fmt::format("'{}' is neither on nor off", text), "Write on or off");
  }
  static void check(bool, const Parameter&, const std::string&) {}
};

template <>
struct Reading<std::string> {
  static constexpr FieldKind kind = FieldKind::text;
  static std::string text(const std::string& value) { return value; }
  static std::string read(std::string_view text, const Parameter&, const std::string&) {
    return std::string(text);
  }
  static void check(const std::string&, const Parameter&, const std::string&) {}
};

template <class T>
class Plain final : public Field {
 public:
  Plain(T& value, const Parameter& about) : value_(value), about_(about) {}
  FieldKind kind() const override { return Reading<T>::kind; }
  bool given() const override {
    if constexpr (std::is_same_v<T, std::string>) return !value_.empty();
    else return true;
  }
  std::string text() const override { return Reading<T>::text(value_); }
  void read(std::string_view text, const std::string& subject) override {
    value_ = Reading<T>::read(text, about_, subject);
  }
  void clear() override {
    if constexpr (std::is_same_v<T, std::string>) value_.clear();
  }
  void check(const std::string& subject) const override {
    Reading<T>::check(value_, about_, subject);
  }

 private:
  T& value_;
  const Parameter& about_;
};

template <class T>
class Optional final : public Field {
 public:
  Optional(std::optional<T>& value, const Parameter& about) : value_(value), about_(about) {}
  FieldKind kind() const override { return Reading<T>::kind; }
  bool given() const override { return value_.has_value(); }
  std::string text() const override { return value_ ? Reading<T>::text(*value_) : std::string(); }
  void read(std::string_view text, const std::string& subject) override {
    value_ = Reading<T>::read(text, about_, subject);
  }
  void clear() override { value_.reset(); }
  void check(const std::string& subject) const override {
    if (value_) Reading<T>::check(*value_, about_, subject);
  }

 private:
  std::optional<T>& value_;
  const Parameter& about_;
};

class List final : public Field {
 public:
  List(std::vector<std::string>& value, const Parameter& about) : value_(value), about_(about) {}
  FieldKind kind() const override { return FieldKind::list; }
  bool given() const override { return !value_.empty(); }
  std::string text() const override { return fmt::format("{}", fmt::join(value_, ",")); }
  void read(std::string_view text, const std::string& subject) override {
    value_.clear();
    add(text, subject);
  }
  /// Appends names that are separated by commas. Names of files may contain commas, so a file's
  /// text is not split.
  void add(std::string_view text, const std::string& subject) override {
    if (about_.file != FileRole::none) {
      value_.emplace_back(text);
      return;
    }
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t comma = std::min(text.find(',', from), text.size());
      const std::string_view one = trimmed(text.substr(from, comma - from));
      if (one.empty() && !text.empty())
        throw UsageError(subject, fmt::format("'{}' has an empty name", text),
                         "Leave out the comma");
      if (!one.empty()) value_.emplace_back(one);
      from = comma + 1;
    }
  }
  void clear() override { value_.clear(); }

 private:
  std::vector<std::string>& value_;
  const Parameter& about_;
};

class Choice final : public Field {
 public:
  Choice(int& index, const std::vector<std::string>& names, const char* none)
      : index_(index), names_(names), none_(none) {}
  FieldKind kind() const override { return FieldKind::choice; }
  std::vector<std::string> choices() const override {
    std::vector<std::string> all;
    if (none_ && *none_) all.emplace_back(none_);
    all.insert(all.end(), names_.begin(), names_.end());
    return all;
  }
  bool given() const override { return index_ >= 0; }
  std::string text() const override {
    return index_ >= 0 && index_ < static_cast<int>(names_.size())
               ? names_[static_cast<std::size_t>(index_)]
               : std::string();
  }
  void read(std::string_view text, const std::string& subject) override {
    if (none_ && *none_ && text == none_) {
      index_ = -1;
      return;
    }
    const auto found = std::ranges::find(names_, text);
    if (found == names_.end())
      throw UsageError(subject, fmt::format("'{}' is not known", text),
                       "Choose " + in_words(choices()));
    index_ = static_cast<int>(found - names_.begin());
  }
  void clear() override {
    if (none_) index_ = -1;
  }
  void check(const std::string& subject) const override {
    if (index_ >= (none_ ? -1 : 0) && index_ < static_cast<int>(names_.size())) return;
    throw UsageError(subject, fmt::format("there is no choice {}", index_),
                     "Choose " + in_words(choices()));
  }

 private:
  /// "mirror, flat or periodic".
  static std::string in_words(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
      text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return text;
  }

  int& index_;
  const std::vector<std::string>& names_;
  const char* none_;  // null: a choice is always made
};

class Form final : public Field {
 public:
  Form(FieldKind kind, std::function<std::string()>& write,
       std::function<void(std::string_view, const std::string&)>& read)
      : kind_(kind), write_(write), read_(read) {}
  FieldKind kind() const override { return kind_; }
  bool given() const override { return !write_().empty(); }
  std::string text() const override { return write_(); }
  void read(std::string_view text, const std::string& subject) override { read_(text, subject); }

 private:
  FieldKind kind_;
  std::function<std::string()>& write_;
  std::function<void(std::string_view, const std::string&)>& read_;
};

}  // namespace

std::string_view unit_suffix(Unit unit) {
  switch (unit) {
    case Unit::none:
    case Unit::share:
      return "";
    case Unit::nm:
      return "_nm";
    case Unit::ev:
      return "_ev";
    case Unit::deg:
      return "_deg";
    case Unit::pa:
      return "_pa";
    case Unit::us:
      return "_us";
    case Unit::s:
      return "_s";
  }
  return "";
}

bool Limits::holds(double value) const {
  return std::isfinite(value) && (low_open ? value > low : value >= low) &&
         (high_open ? value < high : value <= high);
}

std::string_view Parameter::last_name() const {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? std::string_view(name) : std::string_view(name).substr(dot + 1);
}

std::string Parameter::subject() const { return "`" + name + "`"; }

std::string Parameter::key() const { return name + std::string(unit_suffix(unit)); }

void ParameterVisitor::operator()(double& value, const Parameter& about) {
  Plain<double> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(int& value, const Parameter& about) {
  Plain<int> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::int64_t& value, const Parameter& about) {
  Plain<std::int64_t> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::uint64_t& value, const Parameter& about) {
  Plain<std::uint64_t> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(bool& value, const Parameter& about) {
  Plain<bool> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::string& value, const Parameter& about) {
  Plain<std::string> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::vector<std::string>& value, const Parameter& about) {
  List field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::optional<double>& value, const Parameter& about) {
  Optional<double> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::optional<int>& value, const Parameter& about) {
  Optional<int> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::optional<std::int64_t>& value, const Parameter& about) {
  Optional<std::int64_t> field(value, about);
  visit(about, field);
}
void ParameterVisitor::operator()(std::optional<std::string>& value, const Parameter& about) {
  Optional<std::string> field(value, about);
  visit(about, field);
}

void ParameterVisitor::choice(int& index, std::vector<std::string> names, const Parameter& about) {
  Choice field(index, names, nullptr);
  visit(about, field);
}

void ParameterVisitor::optional_choice(int& index, std::vector<std::string> names,
                                       const Parameter& about, const char* none) {
  Choice field(index, names, none);
  visit(about, field);
}

void ParameterVisitor::form(const Parameter& about, std::function<std::string()> write,
                            std::function<void(std::string_view, const std::string&)> read,
                            FieldKind kind) {
  Form field(kind, write, read);
  visit(about, field);
}

double parse_value(std::string_view text, const Parameter& about, const std::string& subject) {
  double value = 0;
  switch (about.unit) {
    case Unit::none:
      if (!read_all(trimmed(text), value) || !std::isfinite(value))
        throw UsageError(subject, fmt::format("'{}' is no number", text),
                         "Give a finite number, as 12.5");
      break;
    case Unit::share:
      value = parse_share(trimmed(text), subject);
      break;
    case Unit::nm:
      value = parse_length_nm(text, subject);
      break;
    case Unit::ev:
      value = parse_energy_ev(text, subject);
      break;
    case Unit::deg:
      value = parse_angle_deg(text, subject);
      break;
    case Unit::pa:
      value = parse_current_pa(text, subject);
      break;
    case Unit::us:
      value = parse_time_us(text, subject);
      break;
    case Unit::s:
      value = parse_duration_s(text, subject);
      break;
  }
  if (!about.limits.holds(value)) refuse_value(fmt::format("'{}'", text), about, subject, false);
  return value;
}

std::string format_value(double value, Unit unit) {
  const auto number = [](double v) {
    std::string text = fmt::format("{}", v);
    if (!(std::abs(v) >= 1e6)) return text;
    const std::string power = fmt::format("{:g}", v);  // "1e+08"
    const std::size_t plus = power.find("e+");
    double same = 0;
    if (plus == std::string::npos || !read_all(power, same) || same != v) return text;
    const std::size_t digits = power.find_first_not_of('0', plus + 2);
    return digits == std::string::npos ? text : power.substr(0, plus + 1) + power.substr(digits);
  };
  switch (unit) {
    case Unit::none:
      return number(value);
    case Unit::share: {
      if (!(value > 0) || !std::isfinite(value)) return number(value);
      std::string share = format_share(value);
      std::erase(share, ' ');
      return share;
    }
    case Unit::nm:
      for (const auto& [nm, name] : {std::pair{1e9, "m"}, {1e6, "mm"}})
        if (std::abs(value) >= nm && std::fmod(value, nm) == 0) return number(value / nm) + name;
      return number(value) + "nm";
    case Unit::ev:
      return std::abs(value) >= 1000 && std::isfinite(value) ? number(value / 1000) + "keV"
                                                             : number(value) + "eV";
    case Unit::deg:
      return number(value) + "deg";
    case Unit::pa:
      return number(value) + "pA";
    case Unit::us:
      return number(value) + "us";
    case Unit::s:
      return number(value) + "s";
  }
  return number(value);
}

std::string format_limits(const Parameter& about) {
  const Limits& l = about.limits;
  const std::string low = format_value(l.low, about.unit), high = format_value(l.high, about.unit);
  if (std::isfinite(l.low) && std::isfinite(l.high))
    return fmt::format("{}{} {} {}", l.low_open ? "above " : "", low, l.low_open ? "and" : "to",
                       l.high_open  ? "below " + high
                       : l.low_open ? "at most " + high
                                    : high);
  if (std::isfinite(l.low)) return l.low_open ? "above " + low : low + " or more";
  if (std::isfinite(l.high)) return l.high_open ? "below " + high : high + " or less";
  return "";
}

std::string form_of(const Parameter& about, const Field& field) {
  if (!about.form.empty()) return about.form;
  if (about.file == FileRole::written_folder) return "FOLDER";
  if (about.file != FileRole::none) return "FILE";
  switch (field.kind()) {
    case FieldKind::flag:
      return "";
    case FieldKind::whole:
      return "N";
    case FieldKind::choice:
      return fmt::format("{}", fmt::join(field.choices(), "|"));
    case FieldKind::text:
      return "TEXT";
    case FieldKind::list:
      return "NAME,...";
    case FieldKind::number:
      break;
  }
  switch (about.unit) {
    case Unit::none:
      return "NUMBER";
    case Unit::share:
      return "SHARE";
    case Unit::nm:
      return "LENGTH";
    case Unit::ev:
      return "ENERGY";
    case Unit::deg:
      return "ANGLE";
    case Unit::pa:
      return "CURRENT";
    case Unit::us:
    case Unit::s:
      return "TIME";
  }
  return "VALUE";
}

namespace parameters_detail {

void check_field(const Parameter& about, Field& field) { field.check(about.subject()); }

void record_field(const Parameter& about, Field& field, Record& record) {
  if (about.recorded && field.given()) record[about.key()] = field.text();
}

}  // namespace parameters_detail
}  // namespace surf
