// SPDX-License-Identifier: GPL-3.0-or-later
// Asylum Research's .ibw: an Igor binary wave of version 5 (Igor Pro Technical Note 003) of two or
// three dimensions, x fastest, y upward, then the layers. The note behind the samples has lines
// "key: value".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

// BinHeader5, then WaveHeader5, then the samples.
constexpr std::size_t note_size_at = 12, formula_size_at = 8, units_size_at = 16,
                      label_sizes_at = 36;
constexpr std::size_t wave_header = 64, type_at = wave_header + 16, name_at = wave_header + 28,
                      dimensions_at = wave_header + 68, steps_at = wave_header + 84,
                      data_unit_at = wave_header + 148, units_at = wave_header + 152, data_at = 384;
constexpr std::size_t unit_bytes = 4, label_bytes = 32;

std::endian order_of(std::string_view content) {
  return content.size() > 1 && content[0] == 0 ? std::endian::big : std::endian::little;
}

SampleType sample_type(const Bytes& bytes, int type) {
  switch (type) {
    case 2:
      return SampleType::float32;
    case 4:
      return SampleType::float64;
    case 8:
      return SampleType::int8;
    case 16:
      return SampleType::int16;
    case 32:
      return SampleType::int32;
    case 8 + 64:
      return SampleType::uint8;
    case 16 + 64:
      return SampleType::uint16;
    case 32 + 64:
      return SampleType::uint32;
    default:
      bytes.fail(fmt::format("its numbers are of kind {}, not real ones", type),
                 "Export real numbers");
  }
}

/// What Asylum's channels are in: a wave has one unit for all of them.
std::string unit_by_name(const std::string& name) {
  const std::string lower = lower_case(name);
  for (const char* word : {"height", "zsensor", "deflection", "amplitude"})
    if (lower.starts_with(word)) return "m";
  if (lower.starts_with("phase")) return "deg";
  if (lower.starts_with("current")) return "A";
  if (lower.starts_with("frequency")) return "Hz";
  if (lower.starts_with("potential")) return "V";
  return {};
}

}  // namespace

bool is_ibw(std::string_view content) {
  if (content.size() < data_at) return false;
  const Bytes bytes("", content);
  const std::endian order = order_of(content);
  // The first 384 bytes are numbers that add up to 0.
  if (bytes.number<std::int16_t>(0, order) != 5) return false;
  std::uint16_t sum = 0;
  for (std::size_t at = 0; at < data_at; at += 2)
    sum = static_cast<std::uint16_t>(sum + bytes.number<std::uint16_t>(at, order));
  return sum == 0;
}

Scan parse_ibw(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const std::endian order = order_of(content);
  const auto count = [&](std::size_t at) {
    const auto value = bytes.number<std::int32_t>(at, order);
    if (value < 0) bytes.fail(fmt::format("a size in its header is {}", value));
    return static_cast<std::size_t>(value);
  };
  const SampleType type = sample_type(bytes, bytes.number<std::int16_t>(type_at, order));
  const std::size_t width = count(dimensions_at), height = count(dimensions_at + 4);
  const std::size_t layers = std::max<std::size_t>(count(dimensions_at + 8), 1);
  if (width > 0 && height == 0)
    bytes.fail("it is a curve, not an image", "Give a wave of two or three dimensions");
  check_scan_size(file, double(width), double(height), bytes_of(type), content.size());
  const std::size_t layer_bytes = width * height * bytes_of(type);
  if (layers > (content.size() - data_at) / layer_bytes) bytes.require(data_at, content.size());
  std::size_t at = data_at + layers * layer_bytes + count(formula_size_at);
  Scan scan{"Asylum Research", {}, {}, {}};
  std::string note(bytes.part(at, count(note_size_at)).text());
  at += note.size() + count(units_size_at);
  for (std::size_t i = 0; i < 4; ++i) at += count(units_size_at + 4 + 4 * i);
  for (std::size_t i = 0; i < 2; ++i) at += count(label_sizes_at + 4 * i);
  const std::size_t labels =
      count(label_sizes_at + 8) / label_bytes;  // the first is the dimension's own
  std::replace(note.begin(), note.end(), '\r', '\n');
  for_each_text_line(note, [&](std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || colon == 0) return;
    scan.metadata[clean_text(line.substr(0, colon))] = clean_text(line.substr(colon + 1));
  });
  const auto unit_nm = [&](std::size_t axis) {
    return scan_length_nm(bytes.fixed_text(units_at + axis * unit_bytes, unit_bytes));
  };
  const auto step = [&](std::size_t axis) {
    return std::abs(bytes.number<double>(steps_at + 8 * axis, order));
  };
  for (std::size_t layer = 0; layer < layers; ++layer) {
    ScanChannel channel;
    channel.name = clean_text(layer + 1 < labels
                                  ? bytes.fixed_text(at + (layer + 1) * label_bytes, label_bytes)
                                  : bytes.fixed_text(name_at, label_bytes));
    channel.z_unit = unit_by_name(channel.name);
    if (channel.z_unit.empty())
      channel.z_unit = clean_text(bytes.fixed_text(data_unit_at, unit_bytes));
    channel.width = static_cast<int>(width);
    channel.height = static_cast<int>(height);
    channel.pitch_guessed = !unit_nm(0) || !unit_nm(1);
    channel.pitch_x_nm = step(0) * unit_nm(0).value_or(1);
    channel.pitch_y_nm = step(1) * unit_nm(1).value_or(1);
    channel.values = [part = bytes.part(data_at + layer * layer_bytes, layer_bytes),
                      w = channel.width, h = channel.height, type,
                      order] { return read_samples(part, w, h, {.type = type, .order = order}); };
    scan.channels.push_back(std::move(channel));
  }
  return scan;
}

}  // namespace surf::io
