// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_header.h"

#include <cmath>

#include "../afm/scan.h"

namespace surf::io {
namespace {

void append_utf8(std::string& text, unsigned code) {
  const auto add = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xc0 | code >> 6), add(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    add(0xe0 | code >> 12), add(0x80 | (code >> 6 & 0x3f)), add(0x80 | (code & 0x3f));
  } else {
    add(0xf0 | code >> 18), add(0x80 | (code >> 12 & 0x3f)), add(0x80 | (code >> 6 & 0x3f)),
        add(0x80 | (code & 0x3f));
  }
}

}  // namespace

std::string decoded_utf16(std::string_view bytes, bool low_byte_first) {
  std::string text;
  const auto unit = [&](std::size_t i) {
    const unsigned a = static_cast<unsigned char>(bytes[i]),
                   b = static_cast<unsigned char>(bytes[i + 1]);
    return low_byte_first ? a | b << 8 : a << 8 | b;
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    unsigned code = unit(i);
    if (code == 0) break;
    if (code >= 0xd800 && code < 0xe000) {
      const unsigned low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      const bool pair = low >= 0xdc00 && low < 0xe000;
      code = pair ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : 0xfffd;
      if (pair) i += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

std::string decoded_text(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xff\xfe"sv)) return decoded_utf16(bytes.substr(2), true);
  if (bytes.starts_with("\xfe\xff"sv)) return decoded_utf16(bytes.substr(2), false);
  if (bytes.starts_with("\xef\xbb\xbf"sv)) bytes.remove_prefix(3);
  return std::string(bytes);
}

Settings parse_settings(std::string_view text) {
  Settings settings;
  std::string section;
  for_each_text_line(text, [&](std::string_view line) {
    line = trimmed(line);
    if (line.starts_with('[') && line.ends_with(']')) {
      section = clean_text(line.substr(1, line.size() - 2)) + ".";
      return;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || equals == 0) return;
    const std::string value = clean_text(trimmed(line.substr(equals + 1)));
    if (!value.empty())
      settings.emplace(section + clean_text(trimmed(line.substr(0, equals))), value);
  });
  return settings;
}

std::string setting(const Settings& settings, const std::string& key) {
  const auto found = settings.find(key);
  return found == settings.end() ? std::string() : found->second;
}

std::optional<double> number_of(const Settings& settings, const std::string& key, double factor) {
  std::string_view rest;
  const std::string text = setting(settings, key);
  const auto number = leading_number(text, rest);
  if (!number || !std::isfinite(*number * factor)) return std::nullopt;
  return *number * factor + 0.0;  // no -0
}

std::optional<double> positive(std::optional<double> value) {
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> voltage_ev(std::string_view text) {
  std::string_view rest;
  const auto number = leading_number(text, rest);
  if (!number) return std::nullopt;
  const std::string unit = lower_case(trimmed(rest));
  if (unit == "kv") return positive(1e3 * *number);
  if (unit == "v" || unit == "volt") return positive(*number);
  return std::nullopt;
}

std::optional<double> length_nm(std::string_view text) {
  std::string_view rest;
  const auto number = leading_number(text, rest);
  const auto unit = number ? scan_length_nm(trimmed(rest)) : std::nullopt;
  return unit ? positive(*number * *unit) : std::nullopt;
}

void set_pixel(SemHeader& header, std::optional<double> x_nm, std::optional<double> y_nm,
               std::string from) {
  if (!positive(x_nm)) return;
  header.pixel_x_nm = *x_nm;
  header.pixel_y_nm = positive(y_nm).value_or(*x_nm);
  header.pixel_from = std::move(from);
}

int rows_below(SemSize size, std::optional<double> image_rows) {
  if (!image_rows || !(*image_rows > 0.5 * size.height && *image_rows < size.height)) return 0;
  return size.height - static_cast<int>(*image_rows);
}

}  // namespace surf::io
