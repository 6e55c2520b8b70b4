// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <system_error>

#include "surf/core/error.h"

namespace surf {
namespace {

// Scales are quotients of whole numbers where possible, so that "9pm" is exactly 0.009.
struct Unit {
  std::string_view name;
  double multiply;
  double divide;
};

constexpr std::array length_units{
    Unit{"nm", 1, 1},        Unit{"um", 1e3, 1}, Unit{"\u00b5m", 1e3, 1},
    Unit{"\u03bcm", 1e3, 1}, Unit{"mm", 1e6, 1}, Unit{"m", 1e9, 1},
    Unit{"pm", 1, 1e3},      Unit{"A", 1, 10},   Unit{"in", 2.54e7, 1},
};
constexpr std::array energy_units{Unit{"ev", 1, 1}, Unit{"kev", 1e3, 1}, Unit{"mev", 1e6, 1}};
constexpr std::array angle_units{
    Unit{"deg", 1, 1},
    Unit{"\u00b0", 1, 1},
    Unit{"rad", 57.29577951308232, 1},
    Unit{"mrad", 57.29577951308232, 1e3},
};

constexpr std::array current_units{Unit{"pA", 1, 1}, Unit{"nA", 1e3, 1}, Unit{"uA", 1e6, 1},
                                   Unit{"fA", 1, 1e3}, Unit{"A", 1e12, 1}};
constexpr std::array time_units{Unit{"us", 1, 1},   Unit{"\u00b5s", 1, 1}, Unit{"\u03bcs", 1, 1},
                                Unit{"ns", 1, 1e3}, Unit{"ms", 1e3, 1},    Unit{"s", 1e6, 1}};
constexpr std::array duration_units{Unit{"s", 1, 1}, Unit{"min", 60, 1}, Unit{"h", 3600, 1},
                                    Unit{"d", 86400, 1}, Unit{"ms", 1, 1e3}};

/// The words for a kind of quantity in messages.
struct Kind {
  const char* name;
  std::string_view default_unit;
  const char* remedy;
};

constexpr Kind length_kind{"length", "nm",
                           "Write a number and a unit out of nm, um, mm, m, pm, A, in (bare "
                           "numbers are nm), for example 0.5um"};
constexpr Kind energy_kind{
    "energy", "ev", "Write a number and eV, keV or MeV (bare numbers are eV), for example 1.5keV"};
constexpr Kind angle_kind{
    "angle", "deg",
    "Write a number and deg, rad or mrad (bare numbers are degrees), for example 30deg"};

constexpr Kind current_kind{"current", "pA",
                            "Write a number and pA, nA, uA, fA or A (bare numbers are pA), for "
                            "example 100pA"};
constexpr Kind duration_kind{
    "duration", "s",
    "Write a number and s, min, h, d or ms (bare numbers are seconds), for "
    "example 5min"};
constexpr Kind time_kind{
    "time", "us", "Write a number and us, ns, ms or s (bare numbers are us), for example 10us"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

[[noreturn]] void refuse(std::string_view subject, const std::string& reason, const Kind& kind) {
  throw UsageError(std::string(subject), reason, kind.remedy);
}

struct Quantity {
  double value;
  std::string_view unit;
};

Quantity split(std::string_view text, std::string_view subject, const Kind& kind) {
  std::string_view rest = trimmed(text);
  if (rest.empty()) refuse(subject, fmt::format("the {} is empty", kind.name), kind);
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);

  Quantity result{};
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), result.value);
  if (error == std::errc::result_out_of_range) {
    refuse(subject, fmt::format("'{}' is beyond the range of numbers", text), kind);
  }
  if (error != std::errc{}) {
    const bool vowel = std::string_view("aeiou").find(kind.name[0]) != std::string_view::npos;
    refuse(subject, fmt::format("'{}' is not {} {}", text, vowel ? "an" : "a", kind.name), kind);
  }
  if (!std::isfinite(result.value)) {
    refuse(subject, fmt::format("'{}' is not a finite number", text), kind);
  }
  result.unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (result.unit.starts_with(',')) {
    refuse(subject, fmt::format("'{}' has a comma; decimals are written with a point", text), kind);
  }
  if (result.unit.empty()) result.unit = kind.default_unit;
  return result;
}

const Unit& find_unit(std::span<const Unit> units, std::string_view name, std::string_view subject,
                      const Kind& kind) {
  const auto found = std::ranges::find(units, name, &Unit::name);
  if (found == units.end()) {
    refuse(subject, fmt::format("'{}' is not a unit of {}", name, kind.name), kind);
  }
  return *found;
}

double scaled(double value, const Unit& unit, std::string_view text, std::string_view subject,
              const Kind& kind) {
  const double result = value * unit.multiply / unit.divide;
  if (!std::isfinite(result)) {
    refuse(subject, fmt::format("'{}' is beyond the range of numbers", text), kind);
  }
  return result;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace

double parse_length_nm(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, length_kind);
  return scaled(q.value, find_unit(length_units, q.unit, subject, length_kind), text, subject,
                length_kind);
}

std::pair<double, double> parse_two_lengths_nm(std::string_view text, std::string_view subject) {
  const std::size_t at = text.find_first_of(",x");
  const std::string_view rest = at == std::string_view::npos ? text : text.substr(at + 1);
  if (rest.find_first_of(",x") != std::string_view::npos && rest.size() < text.size())
    throw UsageError(std::string(subject), fmt::format("'{}' is not a pixel size", text),
                     "Write one length, or two for x and y: 2nm or 2nmx3nm");
  const double x = parse_length_nm(text.substr(0, at), subject), y = parse_length_nm(rest, subject);
  if (!(x > 0 && y > 0))
    throw UsageError(std::string(subject), fmt::format("'{}' is not above zero", text),
                     "Write a length, such as 2nm");
  return {x, y};
}

double parse_energy_ev(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, energy_kind);
  const std::string unit = lower_case(q.unit);
  if (unit == "mev" && q.unit[0] == 'm') {
    refuse(subject, fmt::format("'{}' may mean milli- or megaelectronvolt", text), energy_kind);
  }
  // The message repeats the unit as the person spelled it.
  const auto known = std::ranges::find(energy_units, unit, &Unit::name);
  return scaled(
      q.value,
      known != energy_units.end() ? *known : find_unit(energy_units, q.unit, subject, energy_kind),
      text, subject, energy_kind);
}

double parse_angle_deg(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, angle_kind);
  return scaled(q.value, find_unit(angle_units, q.unit, subject, angle_kind), text, subject,
                angle_kind);
}

double parse_current_pa(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, current_kind);
  return scaled(q.value, find_unit(current_units, q.unit, subject, current_kind), text, subject,
                current_kind);
}

double parse_time_us(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, time_kind);
  return scaled(q.value, find_unit(time_units, q.unit, subject, time_kind), text, subject,
                time_kind);
}

double parse_duration_s(std::string_view text, std::string_view subject) {
  const Quantity q = split(text, subject, duration_kind);
  return scaled(q.value, find_unit(duration_units, q.unit, subject, duration_kind), text, subject,
                duration_kind);
}

double parse_share(std::string_view text, std::string_view subject) {
  const bool percent = text.ends_with('%');
  std::string number(text.substr(0, text.size() - (percent ? 1 : 0)));
  while (number.ends_with(' ')) number.pop_back();
  // The decimal point is moved in the text, not in the number, so that 1.3% equals 0.013 exactly.
  if (percent && number.find_first_of("eE") == std::string::npos) number += "e-2";
  double share = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), share);
  if (error != std::errc{} || end != number.data() + number.size() || !std::isfinite(share) ||
      share < 0)
    throw UsageError(std::string(subject), fmt::format("'{}' is not a share", text),
                     "Write for example 1% or 0.01");
  return share;
}

std::string format_share(double share) {
  std::string digits = fmt::format("{}", 100 * share);
  for (int precision = 1; precision <= 17; ++precision) {
    const std::string shorter = fmt::format("{:.{}g}", 100 * share, precision);
    if (shorter.find('e') != std::string::npos) continue;
    if (parse_share(shorter + "%", "share") != share) continue;
    digits = shorter;
    break;
  }
  return digits + " %";
}

double unit_length_nm(std::string_view unit, std::string_view subject) {
  constexpr Kind kind{"length", "", "Give one of nm, um, mm, m, pm, A, in"};
  const Unit& found = find_unit(length_units, unit, subject, kind);
  return found.multiply / found.divide;
}

std::string format_length(double length_nm, int digits) {
  if (digits < 1 || digits > 17) {
    throw UsageError("digits", "it is " + std::to_string(digits),
                     "Give 1 to 17 significant digits");
  }
  if (length_nm == 0 || !std::isfinite(length_nm)) {
    return fmt::format("{} nm", length_nm == 0 ? 0.0 : length_nm);
  }
  // Rounding comes first: 999.9 nm in three digits is 1.00 um.
  const std::string rounded = fmt::format("{:.{}e}", length_nm, digits - 1);
  const char* const exponent_text = rounded.data() + rounded.find('e') + 1;
  int exponent = 0;
  std::from_chars(exponent_text + (*exponent_text == '+'), rounded.data() + rounded.size(),
                  exponent);

  // For lengths far from anything that is measured, zeros would hide the number.
  constexpr int first_digit_of_100_km = 14, first_digit_of_a_femtometre = -6;
  if (exponent >= first_digit_of_100_km)
    return fmt::format("{:.{}e} m", length_nm / 1e9, digits - 1);
  if (exponent < first_digit_of_a_femtometre) return rounded + " nm";

  struct Step {
    int exponent;
    const char* unit;
  };
  constexpr Step steps[] = {{9, "m"}, {6, "mm"}, {3, "um"}, {-1, "nm"}, {-400, "pm"}};
  const Step& step =
      *std::ranges::find_if(steps, [&](const Step& s) { return exponent >= s.exponent; });
  const Unit& unit = *std::ranges::find(length_units, std::string_view(step.unit), &Unit::name);
  const int unit_exponent = static_cast<int>(std::lround(std::log10(unit.multiply / unit.divide)));

  double value = 0;
  std::from_chars(rounded.data(), rounded.data() + rounded.size(), value);
  const int decimals = std::max(0, digits - 1 - exponent + unit_exponent);
  return fmt::format("{:.{}f} {}", value * unit.divide / unit.multiply, decimals, step.unit);
}

std::string format_exact(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

}  // namespace surf
