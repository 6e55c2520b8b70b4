// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "files/damaged.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr double most_samples_across = 1 << 20;

constexpr std::string_view blanks = std::string_view(" \t\r\n\v\f\0", 7);

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t more = first < 0x80       ? 0
                             : first >> 5 == 6  ? 1
                             : first >> 4 == 14 ? 2
                             : first >> 3 == 30 ? 3
                                                : 9;
    if (more == 9 || text.size() - i <= more) return false;
    for (std::size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
    i += more + 1;
  }
  return true;
}

/// Length of the number at the front of `text`, which may have a decimal comma.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t first = i;
    while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
    return i - first;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t found = digits();
  if (i < text.size() && (text[i] == '.' || text[i] == ',')) {
    ++i;
    found += digits();
  }
  if (found == 0) return 0;
  const std::size_t before_exponent = i;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) i = before_exponent;
  }
  return i;
}

}  // namespace

std::optional<double> scan_length_nm(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 22> units{
      {{"m", 1e9},         {"meter", 1e9},        {"metre", 1e9},
       {"cm", 1e7},        {"mm", 1e6},           {"km", 1e12},
       {"um", 1e3},        {"~m", 1e3},           {"\xC2\xB5m", 1e3},
       {"\xCE\xBCm", 1e3}, {"\xB5m", 1e3},        {"micron", 1e3},
       {"nm", 1},          {"pm", 1e-3},          {"fm", 1e-6},
       {"\xC3\x85", 0.1},  {"\xE2\x84\xAB", 0.1}, {"\xC5", 0.1},
       {"Ang", 0.1},       {"Angstrom", 0.1},     {"angstrom", 0.1},
       {"microns", 1e3}}};
  unit = trimmed(unit);
  const auto found =
      std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == unit; });
  if (found == units.end()) return std::nullopt;
  return found->second;
}

bool holds_heights(const ScanChannel& channel) {
  if (!trimmed(channel.z_unit).empty() && !scan_length_nm(channel.z_unit)) return false;
  const std::string name = lower_case(channel.name);
  for (const char* word :
       {"amplitude", "deflection", "error", "phase", "friction", "lateral", "current", "adhesion",
        "potential", "slope", "frequency", "dissipation", "setpoint"}) {
    if (name.find(word) != std::string::npos) return false;
  }
  return true;
}

void check_scan_size(const std::string& file, double width, double height, std::size_t bytes_each,
                     std::size_t file_bytes) {
  const bool possible = width >= 1 && height >= 1 && width <= most_samples_across &&
                        height <= most_samples_across && width == std::floor(width) &&
                        height == std::floor(height);
  if (!possible) {
    throw FileError(file, fmt::format("an image of {:g} x {:g} samples cannot be", width, height),
                    copy_again);
  }
  if (width * height * double(bytes_each) > double(file_bytes)) {
    throw FileError(
        file,
        fmt::format("its {:.0f} x {:.0f} samples take {:.0f} bytes, and the file has {}", width,
                    height, width * height * double(bytes_each), file_bytes),
        copy_again);
  }
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::optional<double> leading_number(std::string_view text, std::string_view& rest) {
  text = trimmed(text);
  const std::size_t length = number_length(text);
  if (length == 0) return std::nullopt;
  std::string plain(text.substr(0, length));
  std::replace(plain.begin(), plain.end(), ',', '.');
  const char* const begin = plain.data() + (plain[0] == '+' ? 1 : 0);
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, plain.data() + plain.size(), value);
  if (error == std::errc::invalid_argument) return std::nullopt;
  // 1e400 and 1e-400 are both out of range; the latter is as good as 0.
  if (error == std::errc::result_out_of_range) value = std::strtod(plain.c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  rest = trimmed(text.substr(length));
  return value;
}

std::optional<double> scan_number(std::string_view text) {
  const std::string word = lower_case(trimmed(text));
  if (word == "nan" || word == "-nan" || word == "+nan")
    return std::numeric_limits<double>::quiet_NaN();
  std::string_view rest;
  const auto value = leading_number(text, rest);
  return value && rest.empty() ? value : std::nullopt;
}

std::string clean_text(std::string_view text) {
  text = trimmed(text);
  const bool utf8 = is_utf8(text);
  std::string clean;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte == 0x7F) {
      clean += ' ';
    } else if (byte >= 0x80 && !utf8) {
      clean += static_cast<char>(0xC0 | byte >> 6);
      clean += static_cast<char>(0x80 | (byte & 0x3F));
    } else {
      clean += c;
    }
  }
  return clean;
}

}  // namespace surf::io
