// SPDX-License-Identifier: GPL-3.0-or-later
#include "../afm/scan.h"
#include "sem_header.h"

namespace surf::io {
namespace {

/// The rest of "Vacc=15.0kV Mag=x1.20k" behind "Vacc=", up to a blank.
std::string part_of(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return std::string(text.substr(0, text.find(' ')));
}

/// The second of "1280x960".
std::optional<double> rows_of(std::string_view size) {
  const std::size_t x = size.find('x');
  return x == std::string_view::npos ? std::nullopt : scan_number(size.substr(x + 1));
}

}  // namespace

bool is_hitachi_text(std::string_view text) { return trimmed(text).starts_with("[SemImageFile]"); }

SemHeader parse_hitachi(std::string_view text, SemSize size) {
  SemHeader header;
  header.format = "Hitachi";
  for (const auto& [key, value] : parse_settings(text))
    header.metadata.emplace(key.substr(key.find('.') + 1), value);
  const Settings& s = header.metadata;
  set_pixel(header, number_of(s, "PixelSize"), {}, "PixelSize");
  // What is repeated in the image has energy and distance in one line.
  const std::string condition = setting(s, "Condition");
  header.energy_ev = voltage_ev(setting(s, "AcceleratingVoltage"));
  if (!header.energy_ev) header.energy_ev = voltage_ev(part_of(condition, "Vacc="));
  header.working_distance_nm = length_nm(setting(s, "WorkingDistance"));
  if (!header.working_distance_nm)
    header.working_distance_nm = length_nm(part_of(condition, "WD="));
  header.tilt_deg = number_of(s, "StagePositionT");
  header.detector = setting(s, "SignalName");
  header.instrument = setting(s, "InstructName");
  header.databar_rows = rows_below(size, rows_of(setting(s, "DataSize")));
  return header;
}

}  // namespace surf::io
