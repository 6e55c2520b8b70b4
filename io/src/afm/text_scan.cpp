// SPDX-License-Identifier: GPL-3.0-or-later
// Heights as text: a matrix, or lines of x, y and z on a grid, in any order.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "number_table.h"
#include "scan_formats.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

/// What the lines before the numbers say.
struct TextHeader {
  std::string name, z_unit;
  std::optional<double> width_nm, height_nm;  ///< of the whole matrix
  std::optional<double> pitch_nm;
  std::optional<double> xy_unit_nm;  ///< of coordinates
  double z_factor = 1;               ///< from the numbers to z_unit
  std::string description;           ///< lines of ours
};

std::optional<double> length_nm(std::string_view text) {
  std::string_view unit;
  const auto value = leading_number(text, unit);
  const auto nm = scan_length_nm(unit);
  if (!value || !nm || !(*value > 0)) return std::nullopt;
  return *value * *nm;
}

bool is_one_of(const std::string& key, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), key) != words.end();
}

void apply_header_line(std::string_view key_text, std::string_view value, TextHeader& header) {
  const std::string key = lower_case(trimmed(key_text));
  if (is_one_of(key, {"channel", "kanal", "title", "titel"})) header.name = clean_text(value);
  if (is_one_of(key, {"width", "breite"})) header.width_nm = length_nm(value);
  if (is_one_of(key, {"height", "h\xC3\xB6he", "h\xF6he"})) header.height_nm = length_nm(value);
  if (is_one_of(key, {"pixel size", "pixel_size", "pitch"})) header.pitch_nm = length_nm(value);
  if (is_one_of(key, {"xy unit", "xy units", "x unit", "x units", "lateral unit"}))
    header.xy_unit_nm = scan_length_nm(value);
  const bool converted = header.z_factor != 1;
  if (is_one_of(key, {"value units", "value unit", "data unit", "z unit", "z units", "einheit"}) &&
      !converted)
    header.z_unit = clean_text(value);
  if (key == "height conversion factor (-> m)") {
    if (const auto factor = scan_number(value); factor && *factor > 0) {
      header.z_factor = *factor;
      header.z_unit.assign(1, 'm');  // GCC 12 warns of a plain assignment
    }
  }
}

// Gwyddion writes channel, width, height and unit, in this order and in the words of its user's
// language.
void apply_gwyddion_order(const std::vector<std::string_view>& lines, TextHeader& header) {
  if (lines.size() < 4) return;
  std::string_view values[4];
  for (int i = 0; i < 4; ++i) {
    const std::size_t colon = lines[std::size_t(i)].find(':');
    if (colon == std::string_view::npos) return;
    values[i] = lines[std::size_t(i)].substr(colon + 1);
  }
  const auto width = length_nm(values[1]), height = length_nm(values[2]);
  if (!width || !height) return;
  header.name = clean_text(values[0]);
  header.width_nm = width;
  header.height_nm = height;
  header.z_unit = clean_text(values[3]);
}

TextHeader parse_header(const std::vector<std::string_view>& lines) {
  TextHeader header;
  for (const std::string_view line : lines) {
    header.description.append(line).append("\n");
    const std::size_t sign = line.find_first_of(":=");
    if (sign == std::string_view::npos) continue;
    // "height conversion factor (-> m)=2e-8" and "pixel size=1e-7 m" have theirs behind a blank.
    apply_header_line(line.substr(0, sign), line.substr(sign + 1), header);
  }
  apply_gwyddion_order(lines, header);
  return header;
}

ScanChannel matrix(const std::string& file, const NumberTable& table, const TextHeader& header,
                   std::size_t file_bytes) {
  check_scan_size(file, double(table.columns), double(table.rows), 1, file_bytes + 1);
  ScanChannel channel;
  channel.width = static_cast<int>(table.columns);
  channel.height = static_cast<int>(table.rows);
  if (header.pitch_nm) channel.pitch_x_nm = channel.pitch_y_nm = *header.pitch_nm;
  if (header.width_nm) channel.pitch_x_nm = *header.width_nm / channel.width;
  if (header.height_nm) channel.pitch_y_nm = *header.height_nm / channel.height;
  auto grid = std::make_shared<Grid<double>>(channel.width, channel.height);
  for (int y = 0; y < channel.height; ++y)
    for (int x = 0; x < channel.width; ++x)
      (*grid)(x, channel.height - 1 - y) =
          header.z_factor * table.values[std::size_t(y) * table.columns + std::size_t(x)];
  channel.values = [grid] { return *grid; };
  return channel;
}

/// The different values of a coordinate, ascending; those that rounding sets apart count as one.
struct Axis {
  std::vector<double> values;
  double pitch = 0;

  bool make(const std::vector<double>& table, std::size_t offset) {
    for (std::size_t i = offset; i < table.size(); i += 3) {
      if (!std::isfinite(table[i])) return false;
      values.push_back(table[i]);
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    double widest = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
      widest = std::max(widest, values[i] - values[i - 1]);
    constexpr double same = 0.2;
    std::vector<double> apart;
    for (const double v : values)
      if (apart.empty() || v - apart.back() > same * widest) apart.push_back(v);
    values = std::move(apart);
    if (values.size() < 2) return false;
    pitch = (values.back() - values.front()) / double(values.size() - 1);
    constexpr double uneven = 0.2;
    if (!(pitch > 0) || !std::isfinite(pitch)) return false;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::abs(values[i] - values.front() - double(i) * pitch) > uneven * pitch) return false;
    return true;
  }
  int index(double value) const {
    return static_cast<int>(std::lround((value - values.front()) / pitch));
  }
};

/// Points on a grid of which three of four are there and none twice; empty where they are none.
std::optional<ScanChannel> points(const NumberTable& table, const TextHeader& header) {
  Axis x, y;
  if (table.columns != 3 || !x.make(table.values, 0) || !y.make(table.values, 1))
    return std::nullopt;
  constexpr double share = 0.75, fewest = 4;
  const double samples = double(x.values.size()) * double(y.values.size());
  if (double(table.rows) < std::max(share * samples, fewest)) return std::nullopt;
  ScanChannel channel;
  channel.width = static_cast<int>(x.values.size());
  channel.height = static_cast<int>(y.values.size());
  const double unit_nm = header.xy_unit_nm.value_or(1);
  channel.pitch_x_nm = x.pitch * unit_nm;
  channel.pitch_y_nm = y.pitch * unit_nm;
  channel.pitch_guessed = !header.xy_unit_nm;
  auto grid = std::make_shared<Grid<double>>(channel.width, channel.height,
                                             std::numeric_limits<double>::quiet_NaN());
  Mask seen(channel.width, channel.height);
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double* const point = &table.values[3 * i];
    const int column = x.index(point[0]), row = channel.height - 1 - y.index(point[1]);
    if (seen(column, row)++) return std::nullopt;
    (*grid)(column, row) = header.z_factor * point[2];
  }
  channel.values = [grid] { return *grid; };
  return channel;
}

}  // namespace

Scan parse_text_scan(const std::string& file, std::string_view content) {
  const NumberTable table = parse_number_table(file, content);
  const TextHeader header = parse_header(table.header);
  Scan scan;
  const bool sized = header.width_nm || header.height_nm || header.pitch_nm;
  auto channel = sized ? std::nullopt : points(table, header);
  if (channel) {
    scan.format = "text of x, y, z";
    scan.notes.push_back("y is taken to run down, as Gwyddion writes such text");
  } else if (lower_case(file).ends_with(".xyz")) {
    throw FileError(file,
                    fmt::format("its {} rows of {} numbers are no points x, y, z on a regular grid",
                                table.rows, table.columns),
                    "Give every grid point once, or name a matrix .txt");
  } else {
    scan.format = "text matrix";
    channel = matrix(file, table, header, content.size());
  }
  channel->name = header.name;
  channel->z_unit = header.z_unit;
  scan.channels.push_back(std::move(*channel));
  apply_description(header.description, file, scan);
  return scan;
}

}  // namespace surf::io
