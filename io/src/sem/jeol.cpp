// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "../afm/scan.h"
#include "sem_header.h"

namespace surf::io {
namespace {

/// Lines "$CM_MAG 50000" or "$$SM_WD 2.77"; the key without its marks.
Settings parse_lines(std::string_view text) {
  Settings settings;
  for_each_text_line(text, [&](std::string_view line) {
    if (!line.starts_with('$')) return;
    line.remove_prefix(std::min(line.find_first_not_of('$'), line.size()));
    const std::size_t blank = std::min(line.find(' '), line.size());
    const std::string value = clean_text(trimmed(line.substr(blank)));
    if (!value.empty()) settings.emplace(clean_text(line.substr(0, blank)), value);
  });
  return settings;
}

/// The second of two numbers.
std::optional<double> second_number(std::string_view text) {
  std::string_view rest;
  if (!leading_number(text, rest)) return std::nullopt;
  return leading_number(rest, rest);
}

}  // namespace

bool is_jeol_text(std::string_view text) {
  return text.find("$CM_FORMAT JEOL") != std::string_view::npos;
}

SemHeader parse_jeol(std::string_view text, SemSize size) {
  constexpr double millimetre = 1e6;
  SemHeader header;
  header.format = "JEOL";
  header.metadata = parse_lines(text);
  const Settings& s = header.metadata;
  const auto bar_px = positive(number_of(s, "SM_MICRON_BAR"));
  const auto bar_nm = length_nm(setting(s, "SM_MICRON_MARKER"));
  if (bar_px && bar_nm) {
    set_pixel(header, *bar_nm / *bar_px, {}, "SM_MICRON_BAR");
    header.notes.push_back(fmt::format(
        "the pixel size, {:.4g} nm, is from a micron bar of whole {:g} pixels: it may be "
        "{:.1f} % off",
        header.pixel_x_nm, *bar_px, 50 / *bar_px));
  }
  header.energy_ev = positive(number_of(s, "CM_ACCEL_VOLT", 1e3));
  header.working_distance_nm = positive(number_of(s, "SM_WD", millimetre));
  header.detector = setting(s, "CM_SIGNAL");
  header.instrument = setting(s, "CM_INSTRUMENT");
  header.databar_rows = rows_below(size, second_number(setting(s, "CM_FULL_SIZE")));
  return header;
}

}  // namespace surf::io
