// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "info.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "terminal.h"

namespace surf::cli {
namespace {

/// Instruments note hundreds of settings: as many as fit on a screen.
constexpr std::size_t most_settings = 40;

std::string describe_heights(const HeightField& field) {
  double sum = 0, lowest = HUGE_VAL, highest = -HUGE_VAL;
  std::size_t count = 0;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    for (int x = 0; x < field.z_nm.width(); ++x) {
      if (!field.is_valid(x, y)) continue;
      lowest = std::min(lowest, field.z_nm(x, y));
      highest = std::max(highest, field.z_nm(x, y));
      sum += field.z_nm(x, y);
      ++count;
    }
  }
  std::string text =
      fmt::format("{:.6g} to {:.6g}, mean {:.6g} nm", lowest, highest, sum / double(count));
  if (count < field.z_nm.size()) {
    const std::size_t holes = field.z_nm.size() - count;
    text += fmt::format(", {} hole{}", holes, holes == 1 ? "" : "s");
  }
  return text;
}

void print_size(const HeightField& field) {
  const int w = field.z_nm.width(), h = field.z_nm.height();
  print_item("size",
             fmt::format("{} x {} pixels of {} x {}, {} x {}", w, h,
                         format_length(field.pitch_x_nm), format_length(field.pitch_y_nm),
                         format_length(w * field.pitch_x_nm), format_length(h * field.pitch_y_nm)));
}

void print_height_channel(const io::HeightFile& file, std::size_t number,
                          const io::HeightChannel& channel, const std::string& label) {
  if (!channel.is_height) {
    print_item(label, fmt::format("{} x {} pixels in {}, no heights", channel.width, channel.height,
                                  channel.z_unit.empty() ? "an unknown unit" : channel.z_unit));
    return;
  }
  try {
    print_item(label, describe_heights(file.read({std::to_string(number), {}, {}, {}}).field));
  } catch (const Error& error) {
    print_item(label, error.reason());
  }
}

}  // namespace

void print_height_file(const std::filesystem::path& path) {
  const io::HeightFile file(path);
  const std::vector<io::HeightChannel> channels = file.channels();
  const io::HeightFieldFile first = file.read();
  print("{}: heights, {}\n", path.string(), first.format);
  print_size(first.field);
  std::vector<std::string> labels;
  std::size_t width = 0;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    labels.push_back(
        fmt::format("{} {}", i + 1, channels[i].name.empty() ? "heights" : channels[i].name));
    width = std::max(width, labels.back().size());
  }
  for (std::size_t i = 0; i < channels.size(); ++i)
    print_height_channel(file, i + 1, channels[i], fmt::format("{:<{}}", labels[i], width));
  for (const std::string& note : first.notes) print_item("note", note);
  if (first.metadata.empty()) return;
  print("  what it says of itself\n");
  std::size_t longest = 0, printed = 0;
  constexpr std::size_t widest_key = 30;
  for (const auto& item : first.metadata)
    longest = std::min(std::max(longest, item.first.size()), widest_key);
  for (const auto& [key, value] : first.metadata) {
    if (printed++ == most_settings) break;
    print("    {:<{}}  {}\n", key, longest, value);
  }
  if (first.metadata.size() > most_settings)
    print("    and {} more\n", first.metadata.size() - most_settings);
}

}  // namespace surf::cli
