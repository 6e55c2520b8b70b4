// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "../afm/scan.h"
#include "sem_header.h"

namespace surf::io {
namespace {

SemHeader header_of(Settings settings, SemSize size) {
  constexpr double metre = 1e9;
  SemHeader header;
  header.format = "TESCAN";
  const Settings& s = settings;
  set_pixel(header, number_of(s, "PixelSizeX", metre), number_of(s, "PixelSizeY", metre),
            "PixelSizeX");
  header.energy_ev = positive(number_of(s, "HV"));
  header.working_distance_nm = positive(number_of(s, "WD", metre));
  header.tilt_deg = number_of(s, "StageTilt");
  header.detector = setting(s, "Detector");
  header.instrument = setting(s, "Device");
  if (const auto strip = number_of(s, "ImageStripSize"))
    header.databar_rows = rows_below(size, size.height - *strip);
  header.metadata = std::move(settings);
  return header;
}

/// As many of the bytes as make a number, the low one first.
std::size_t little(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

}  // namespace

SemHeader parse_tescan_tag(std::string_view tag, SemSize size) {
  // Blocks of a length in four bytes, then a kind in two and the rest, which it counts: a picture,
  // then texts.
  constexpr std::size_t length_bytes = 4, head_bytes = 6, kind_bytes = head_bytes - length_bytes;
  constexpr std::size_t picture = 1;
  Settings settings;
  while (tag.size() >= head_bytes) {
    const std::size_t told = little(tag.substr(0, length_bytes));
    const std::size_t length = told - std::min(told, kind_bytes);
    const std::size_t kind = little(tag.substr(length_bytes, kind_bytes));
    tag.remove_prefix(head_bytes);
    if (length > tag.size()) break;
    if (kind != picture) settings.merge(parse_settings(tag.substr(0, length)));
    tag.remove_prefix(length);
  }
  return header_of(std::move(settings), size);
}

SemHeader parse_tescan_text(std::string_view text, SemSize size) {
  Settings plain;
  for (const auto& [key, value] : parse_settings(text))
    plain.emplace(key.substr(key.find('.') + 1), value);
  return header_of(std::move(plain), size);
}

}  // namespace surf::io
