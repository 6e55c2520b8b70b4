// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

namespace {

constexpr const char* keys =
    "Use name, energy, cone, axis, sector, side, origin or efficiency, separated by commas";

Detector se(const std::string& name) {
  Detector d;
  d.name = name;
  d.max_energy_ev = se_bse_split_ev;
  return d;
}

Detector bse(const std::string& name) {
  Detector d;
  d.name = name;
  d.min_energy_ev = se_bse_split_ev;
  d.side = Side::up;
  return d;
}

std::vector<Detector> quadrants() {
  constexpr std::array names{"BSE-right", "BSE-top", "BSE-left", "BSE-bottom"};
  std::vector<Detector> out;
  for (int i = 0; i < 4; ++i) {
    Detector d = bse(names[static_cast<std::size_t>(i)]);
    d.from_azimuth_deg = (315 + 90 * i) % 360;
    d.to_azimuth_deg = 45 + 90 * i;
    out.push_back(d);
  }
  return out;
}

std::vector<Detector> preset(std::string_view name) {
  if (name == "SE") return {se("SE")};
  if (name == "BSE") return {bse("BSE")};
  if (name == "SE1" || name == "SE2") {
    Detector d = se(std::string(name));
    d.origin = name == "SE1" ? Origin::se1 : Origin::se2;
    return {d};
  }
  if (name == "quadrants") return quadrants();
  if (name == "annular") {
    Detector d = bse("BSE-annular");
    d.min_angle_deg = 15;
    d.max_angle_deg = 45;
    return {d};
  }
  if (name == "in-lens") {
    Detector d = se("SE-in-lens");
    d.max_angle_deg = 45;
    return {d};
  }
  if (name == "side") {
    Detector d = se("SE-side");
    d.axis = Axis{60, 0};
    d.max_angle_deg = 90;
    return {d};
  }
  return {};
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (c == separator) out.emplace_back();
    else out.back() += c;
  return out;
}

// "A..B"; either end may be missing.
struct Range {
  std::string from, to;
  bool single = false;
};
Range range(const std::string& text) {
  const auto dots = text.find("..");
  if (dots == std::string::npos) return {"", text, true};
  return {text.substr(0, dots), text.substr(dots + 2), false};
}

double share(const std::string& text, const std::string& subject) {
  std::string number = text;
  const bool percent = number.ends_with('%');
  if (percent) number.pop_back();
  // Angles in degrees are plain numbers, too: the same reader, the same messages.
  const double value = parse_angle_deg(number, subject);
  return percent ? value / 100 : value;
}

template <class T>
T choose(const std::string& word, const std::vector<std::pair<std::string, T>>& words,
         const std::string& subject) {
  std::string all;
  for (const auto& [name, value] : words) {
    if (name == word) return value;
    all += (all.empty() ? "" : ", ") + name;
  }
  throw UsageError(subject, fmt::format("'{}' is not known", word), "Choose one of: " + all);
}

const std::vector<std::pair<std::string, Side>> sides{
    {"any", Side::any}, {"up", Side::up}, {"down", Side::down}};
const std::vector<std::pair<std::string, Origin>> origins{
    {"any", Origin::any}, {"se1", Origin::se1}, {"se2", Origin::se2}};

void read_axis(Detector& d, const std::string& value, const std::string& subject) {
  if (value == "beam") {
    d.axis.reset();
    return;
  }
  const auto parts = split(value, '/');
  if (parts.size() > 2)
    throw UsageError(subject, fmt::format("'{}' is no axis", value),
                     "Write beam, or POLAR/AZIMUTH such as 60deg/90deg");
  d.axis = Axis{parse_angle_deg(parts[0], subject),
                parts.size() > 1 ? parse_angle_deg(parts[1], subject) : 0};
}

void apply(Detector& d, const std::string& key, const std::string& value,
           const std::string& subject) {
  const std::string place = subject + ", " + key;
  const Range r = range(value);
  if (key == "name") {
    d.name = value;
  } else if (key == "energy") {
    if (r.single)
      throw UsageError(place, fmt::format("'{}' is no range", value),
                       "Write FROM..TO, such as 50eV.. or 900eV..1keV");
    d.min_energy_ev = r.from.empty() ? 0 : parse_energy_ev(r.from, place);
    d.max_energy_ev =
        r.to.empty() ? std::numeric_limits<double>::infinity() : parse_energy_ev(r.to, place);
  } else if (key == "cone") {
    d.min_angle_deg = r.from.empty() ? 0 : parse_angle_deg(r.from, place);
    d.max_angle_deg = r.to.empty() ? 180 : parse_angle_deg(r.to, place);
  } else if (key == "sector") {
    if (r.single)
      throw UsageError(place, fmt::format("'{}' is no range", value),
                       "Write FROM..TO, such as 315deg..45deg");
    d.from_azimuth_deg = r.from.empty() ? 0 : parse_angle_deg(r.from, place);
    d.to_azimuth_deg = r.to.empty() ? 360 : parse_angle_deg(r.to, place);
  } else if (key == "axis") {
    read_axis(d, value, place);
  } else if (key == "side") {
    d.side = choose(value, sides, place);
  } else if (key == "origin") {
    d.origin = choose(value, origins, place);
  } else if (key == "efficiency") {
    d.efficiency = share(value, place);
  } else if (key == "acceptance") {
    throw UsageError(place, "a table of acceptance is no text",
                     "Give it as a function in Python, or in C++");
  } else {
    throw UsageError(subject, fmt::format("there is no '{}'", key), keys);
  }
}

void check(const Detector& d) {
  const std::string subject = "detector " + d.name;
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (d.name.empty() || !std::all_of(d.name.begin(), d.name.end(), plain))
    throw UsageError("detector", fmt::format("'{}' is no name for a channel", d.name),
                     "Use letters, digits, '-' and '_'");
  if (!(d.min_energy_ev >= 0 && d.min_energy_ev < d.max_energy_ev))
    throw UsageError(subject, "its energy window is empty", "Give 0 <= FROM < TO");
  if (!(d.min_angle_deg >= 0 && d.min_angle_deg < d.max_angle_deg && d.max_angle_deg <= 180))
    throw UsageError(subject,
                     fmt::format("a cone of {:g} to {:g} degrees from its axis is empty or "
                                 "beyond 180",
                                 d.min_angle_deg, d.max_angle_deg),
                     "Give 0 <= FROM < TO <= 180deg");
  const auto in_turn = [](double a) { return a >= 0 && a <= 360; };
  if (!in_turn(d.from_azimuth_deg) || !in_turn(d.to_azimuth_deg) ||
      d.from_azimuth_deg == d.to_azimuth_deg)
    throw UsageError(subject, "its sector is empty or beyond 0 to 360 degrees",
                     "Write for example 315deg..45deg");
  if (d.axis &&
      !(d.axis->polar_deg >= 0 && d.axis->polar_deg <= 180 && std::isfinite(d.axis->azimuth_deg)))
    throw UsageError(subject, "its axis is not 0 to 180 degrees from z",
                     "Write POLAR/AZIMUTH, such as 60deg/90deg");
  if (!(d.efficiency > 0 && d.efficiency <= 1))
    throw UsageError(subject, fmt::format("an efficiency of {:g} is outside 0 to 1", d.efficiency),
                     "Give a share such as 0.8 or 80%");
  if (d.acceptance) validate(*d.acceptance, subject);
}

template <class T>
std::string word_of(T value, const std::vector<std::pair<std::string, T>>& words) {
  for (const auto& [name, v] : words)
    if (v == value) return name;
  return "?";
}

}  // namespace

std::vector<Detector> default_detectors() { return {se("SE"), bse("BSE")}; }

std::vector<Detector> parse_detectors(const std::string& text, const std::string& subject) {
  const auto colon = text.find(':');
  const std::string name = text.substr(0, colon);
  std::vector<Detector> out = preset(name);
  if (out.empty()) {
    if (colon == std::string::npos)
      throw UsageError(subject, fmt::format("there is no detector '{}'", name),
                       "Choose one of: SE1, SE2, quadrants, annular, in-lens, side; or define it, "
                       "as in loss:energy=900eV..1keV");
    out.emplace_back().name = name;
  }
  if (colon != std::string::npos)
    for (const std::string& item : split(text.substr(colon + 1), ',')) {
      const auto equals = item.find('=');
      if (equals == std::string::npos)
        throw UsageError(subject, fmt::format("'{}' has no value", item), keys);
      if (item.starts_with("name=") && out.size() > 1)
        throw UsageError(
            subject, fmt::format("{} are {} detectors with names of their own", name, out.size()),
            "Leave name= out");
      for (Detector& d : out) apply(d, item.substr(0, equals), item.substr(equals + 1), subject);
    }
  for (const Detector& d : out) check(d);
  return out;
}

std::string format_detector(const Detector& d) {
  const auto upper = std::isinf(d.max_energy_ev) ? "" : format_exact(d.max_energy_ev) + "eV";
  const auto axis =
      d.axis ? format_exact(d.axis->polar_deg) + "deg/" + format_exact(d.axis->azimuth_deg) + "deg"
             : "beam";
  return fmt::format(
      "{}:energy={}eV..{},cone={}deg..{}deg,axis={},sector={}deg..{}deg,side={},origin={},"
      "efficiency={}{}",
      d.name, format_exact(d.min_energy_ev), upper, format_exact(d.min_angle_deg),
      format_exact(d.max_angle_deg), axis, format_exact(d.from_azimuth_deg),
      format_exact(d.to_azimuth_deg), word_of(d.side, sides), word_of(d.origin, origins),
      format_exact(d.efficiency), d.acceptance ? ",acceptance=" + hash_of(*d.acceptance) : "");
}

void validate(const std::vector<Detector>& detectors) {
  std::set<std::string> names;
  for (const Detector& d : detectors) {
    check(d);
    if (!names.insert(d.name).second)
      throw UsageError("detector " + d.name, "it is given twice",
                       "Leave one out, or rename it with name=");
  }
}

bool looks_from_a_side(const Detector& d) {
  const bool sector = std::abs(d.to_azimuth_deg - d.from_azimuth_deg) < 360;
  return d.acceptance || sector || (d.axis && d.axis->polar_deg > 0 && d.axis->polar_deg < 180);
}

Vec3 axis_direction(const Detector& d, const Beam& beam) {
  if (!d.axis) return -direction(beam);
  if (d.axis->polar_deg == 0) return {0, 0, 1};
  const double t = d.axis->polar_deg * degrees_to_radians;
  const double a = d.axis->azimuth_deg * degrees_to_radians;
  return normalized({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)});
}

}  // namespace surf::mc
