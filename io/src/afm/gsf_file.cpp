// SPDX-License-Identifier: GPL-3.0-or-later
// Gwyddion Simple Field 1.0 (gwyddion.net/documentation/user-guide-en/gsf.html): a header of lines
// "Key = value", one to four NULs up to a multiple of four bytes, then 32-bit floats,
// little-endian, the top row first. Lengths are in metres unless XYUnits and ZUnits say otherwise.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bytes.h"
#include "scan_formats.h"
#include "surf/core/units.h"

namespace surf::io {
namespace {

constexpr std::string_view magic = "Gwyddion Simple Field 1.0\n";
constexpr double nm_per_m = 1e9;

struct Header {
  std::map<std::string, std::string> keys;
  std::string description;  ///< lines "KEY=VALUE", for what semsurf adds
};

Header parse_header(std::string_view text) {
  Header header;
  for_each_text_line(text, [&](std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return;
    const std::string_view key = trimmed(line.substr(0, equals)),
                           value = trimmed(line.substr(equals + 1));
    header.description += fmt::format("{}={}\n", key, value);
    header.keys[std::string(key)] = clean_text(value);
  });
  return header;
}

double required_count(const Bytes& bytes, const Header& header, const char* key) {
  const auto found = header.keys.find(key);
  if (found == header.keys.end()) bytes.fail(fmt::format("its header has no {}", key));
  const auto value = scan_number(found->second);
  if (!value) bytes.fail(fmt::format("its {} is '{:.40}'", key, found->second));
  return *value;
}

/// Of one pixel; 0 where the header does not say.
double pitch_nm(const Bytes& bytes, const Header& header, const char* key, double count,
                std::optional<double> unit_nm) {
  const auto found = header.keys.find(key);
  if (found == header.keys.end()) return 0;
  const auto value = scan_number(found->second);
  if (!value || !(*value > 0)) bytes.fail(fmt::format("its {} is '{:.40}'", key, found->second));
  return *value / count * unit_nm.value_or(1);
}

}  // namespace

bool is_gsf(std::string_view content) { return content.starts_with(magic); }

Scan parse_gsf(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const std::size_t end = content.find('\0');
  if (end == std::string_view::npos) bytes.fail("its header does not end");
  const std::size_t data = end + (4 - end % 4);
  const Header header = parse_header(content.substr(magic.size(), end - magic.size()));
  ScanChannel channel;
  const double width = required_count(bytes, header, "XRes"),
               height = required_count(bytes, header, "YRes");
  check_scan_size(file, width, height, sizeof(float), content.size());
  channel.width = static_cast<int>(width);
  channel.height = static_cast<int>(height);
  const Bytes values = bytes.part(data, sizeof(float) * static_cast<std::size_t>(width * height));
  const auto text = [&](const char* key) {
    const auto found = header.keys.find(key);
    return found == header.keys.end() ? std::string{} : found->second;
  };
  channel.name = text("Title");
  channel.z_unit = text("ZUnits");
  const auto unit_nm = scan_length_nm(text("XYUnits"));
  channel.pitch_guessed = !unit_nm;
  channel.pitch_x_nm = pitch_nm(bytes, header, "XReal", width, unit_nm);
  channel.pitch_y_nm = pitch_nm(bytes, header, "YReal", height, unit_nm);
  channel.values = [values, w = channel.width, h = channel.height] {
    Grid<double> grid(w, h);
    std::size_t at = 0;
    for (int y = h - 1; y >= 0; --y)
      for (int x = 0; x < w; ++x, at += sizeof(float))
        grid(x, y) = double{values.little<float>(at)};
    return grid;
  };
  Scan scan{"Gwyddion Simple Field", {channel}, header.keys, {}};
  for (const char* key : {"XRes", "YRes", "XReal", "YReal", "XYUnits", "ZUnits", "Title"})
    scan.metadata.erase(key);
  apply_description(header.description, file, scan);
  return scan;
}

std::string format_gsf(const HeightField& field,
                       const std::map<std::string, std::string>& metadata) {
  const int w = field.z_nm.width(), h = field.z_nm.height();
  // Gwyddion's y runs down: its offset is that of the upper left corner.
  const double left_nm = field.origin_x_nm - 0.5 * field.pitch_x_nm;
  const double top_nm = field.origin_y_nm + (h - 0.5) * field.pitch_y_nm;
  std::string text = fmt::format(
      "{}XRes = {}\nYRes = {}\nXReal = {}\nYReal = {}\nXOffset = {}\nYOffset = {}\nXYUnits = "
      "m\nZUnits = m\n"
      "Title = z_nm\n",
      magic, w, h, format_exact(w * field.pitch_x_nm / nm_per_m),
      format_exact(h * field.pitch_y_nm / nm_per_m), format_exact(left_nm / nm_per_m),
      format_exact(-top_nm / nm_per_m));
  for_each_text_line(description_of(field, metadata), [&](std::string_view line) {
    const std::size_t equals = line.find('=');
    text += fmt::format("{} = {}\n", line.substr(0, equals), line.substr(equals + 1));
  });
  text.append(4 - text.size() % 4, '\0');
  text.reserve(text.size() + sizeof(float) * field.z_nm.size());
  for (int y = h - 1; y >= 0; --y) {
    for (int x = 0; x < w; ++x) {
      const float value = field.is_valid(x, y) ? static_cast<float>(field.z_nm(x, y) / nm_per_m)
                                               : std::numeric_limits<float>::quiet_NaN();
      auto bits = std::bit_cast<std::uint32_t>(value);
      for (int byte = 0; byte < 4; ++byte, bits >>= 8) text += static_cast<char>(bits & 0xFF);
    }
  }
  return text;
}

}  // namespace surf::io
