// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/scan_parameters.h"

namespace surf::cli {
namespace {

template <class T>
bool read_all(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::int64_t parse_whole(std::string_view text, std::string_view subject, std::int64_t lowest,
                         std::int64_t highest) {
  const auto fail = [&](const char* reason) {
    return UsageError(std::string(subject), fmt::format("'{}' {}", text, reason),
                      fmt::format("Give a whole number from {} to {}", lowest, highest));
  };
  std::int64_t value = 0;
  if (!read_all(text, value)) {
    double real = 0;
    if (!read_all(text, real) || !std::isfinite(real) || real != std::floor(real))
      throw fail("is not a whole number");
    if (std::abs(real) > 9e15) throw fail("is out of range");
    value = static_cast<std::int64_t>(real);
  }
  if (value < lowest || value > highest) throw fail("is out of range");
  return value;
}

double parse_number(std::string_view text, std::string_view subject) {
  double value = 0;
  if (!read_all(text, value) || !std::isfinite(value))
    throw UsageError(std::string(subject), fmt::format("'{}' is no number", text), "Give a finite number, as 12.5");
  return value;
}

std::vector<double> parse_numbers(std::string_view text, std::string_view subject) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ",")) numbers.push_back(parse_number(part, subject));
  return numbers;
}

std::uint64_t parse_seed(std::string_view text, std::string_view subject) {
  std::uint64_t value = 0;
  if (!read_all(text, value))
    throw UsageError(std::string(subject), fmt::format("'{}' is not a seed", text),
                     fmt::format("Give a whole number from 0 to {}",
                                 std::numeric_limits<std::uint64_t>::max()));
  return value;
}

std::pair<int, int> parse_size(std::string_view text, std::string_view subject) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const auto parts = split(text, "xX");
  if (parts.size() > 2)
    throw UsageError(std::string(subject), fmt::format("'{}' is not a size", text),
                     "Write width x height in pixels, as 256x192");
  const auto width = static_cast<int>(parse_whole(parts[0], subject, 1, most));
  return {width, parts.size() == 1 ? width
                                   : static_cast<int>(parse_whole(parts[1], subject, 1, most))};
}

std::pair<double, double> parse_pixel_size(std::string_view text, std::string_view subject) {
  return io::parse_pitch_nm(text, subject);
}

mc::ScanRequest::Region parse_region(std::string_view text, std::string_view subject) {
  const auto parts = split(text, ",");
  if (parts.size() != 4)
    throw UsageError(std::string(subject), fmt::format("'{}' has {} numbers", text, parts.size()),
                     "Give the outer edges X0,Y0,X1,Y1, as -96,-96,96,96");
  return {parse_length_nm(parts[0], subject), parse_length_nm(parts[1], subject),
          parse_length_nm(parts[2], subject), parse_length_nm(parts[3], subject)};
}

io::MeshUnit parse_mesh_unit(const std::optional<std::string>& unit, bool overrides) {
  if (overrides && !unit)
    throw UsageError("--override-unit", "there is no unit to take in place of the file's", "Add --unit um, or leave it out");
  if (!unit) return {};
  return {parse_unit_nm(*unit, "--unit"), overrides};
}

double parse_unit_nm(std::string_view text, std::string_view subject) { return io::parse_unit_nm(text, subject); }

Edge parse_edge(std::string_view text, std::string_view subject) {
  if (text == "mirror") return Edge::mirror;
  if (text == "flat") return Edge::flat;
  if (text == "periodic") return Edge::periodic;
  throw UsageError(std::string(subject), fmt::format("'{}' is not known", text),
                   "Choose mirror, flat or periodic");
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace surf::cli
