// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../afm/scan.h"
#include "sem_header.h"

namespace surf::io {
namespace {

constexpr int pixel_line = 3;  // of the numbers without names that the text begins with, in m
constexpr double screen_columns = 1024;  // that this number and AP_PIXEL_SIZE are for

/// Pairs of lines, a name as AP_MAG and "Mag = 50.00 K X"; dates have a colon.
Settings parse_pairs(std::string_view text, double& first_pixel_nm) {
  Settings settings;
  std::string name;
  int number = 0;
  for_each_text_line(text, [&](std::string_view line) {
    if (number++ == pixel_line) first_pixel_nm = 1e9 * scan_number(line).value_or(0);
    const bool is_name =
        line.size() > 3 && line[2] == '_' &&
        std::all_of(line.begin(), line.end(), [](unsigned char c) { return c > ' ' && c < 0x7f; });
    if (is_name) {
      name = line;
    } else if (!name.empty()) {
      const std::size_t mark = line.find_first_of("=:");
      if (mark != std::string_view::npos) {
        const std::string value = clean_text(trimmed(line.substr(mark + 1)));
        if (!value.empty()) settings.emplace(name, value);
      }
      name.clear();
    }
  });
  return settings;
}

}  // namespace

SemHeader parse_zeiss(std::string_view text, SemSize size) {
  SemHeader header;
  header.format = "Zeiss SmartSEM";
  double first_nm = 0;
  header.metadata = parse_pairs(text, first_nm);
  const Settings& s = header.metadata;
  const double to_image = screen_columns / size.width;
  const auto image_nm = length_nm(setting(s, "AP_IMAGE_PIXEL_SIZE"));
  const auto screen_nm = length_nm(setting(s, "AP_PIXEL_SIZE"));
  constexpr double same = 0.01;
  if (image_nm) {
    // The number without a name has more digits.
    const bool agrees = std::abs(first_nm * to_image / *image_nm - 1) < same;
    set_pixel(header, agrees ? first_nm * to_image : *image_nm, {}, "AP_IMAGE_PIXEL_SIZE");
  } else {
    const bool agrees = screen_nm && std::abs(first_nm / *screen_nm - 1) < same;
    const auto nm = agrees || !screen_nm ? positive(first_nm) : screen_nm;
    if (nm) set_pixel(header, *nm * to_image, {}, "AP_PIXEL_SIZE");
    if (nm && size.width != int(screen_columns))
      header.notes.push_back(fmt::format(
          "AP_PIXEL_SIZE, {:.5g} nm, is for {:g} columns; of the {} here each is {:.5g} nm", *nm,
          screen_columns, size.width, header.pixel_x_nm));
  }
  header.energy_ev = voltage_ev(setting(s, "AP_ACTUALKV"));
  if (!header.energy_ev) header.energy_ev = voltage_ev(setting(s, "AP_MANUALKV"));
  header.working_distance_nm = length_nm(setting(s, "AP_WD"));
  header.tilt_deg = number_of(s, "AP_STAGE_AT_T");
  header.detector = setting(s, "DP_DETECTOR_CHANNEL");
  if (header.detector.empty()) header.detector = setting(s, "DP_DETECTOR_TYPE");
  header.instrument = setting(s, "SV_SERIAL_NUMBER");
  return header;
}

}  // namespace surf::io
