// SPDX-License-Identifier: GPL-3.0-or-later
// WSxM .stp and .top (wsxm.eu): a header of lines "key: value" of stated length, then the samples,
// turned by 180 degrees: from the lower right corner leftward and up. Heights run from the least to
// the greatest sample over "Z Amplitude".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bytes.h"
#include "samples.h"
#include "scan_formats.h"

namespace surf::io {
namespace {

constexpr std::string_view magic = "WSxM file copyright";
constexpr std::string_view size_key = "Image header size:";

struct Quantity {
  double value = 0;
  std::string unit;
};

}  // namespace

bool is_wsxm(std::string_view content) {
  return content.starts_with(magic) &&
         content.substr(0, 4096).find(size_key) != std::string_view::npos;
}

Scan parse_wsxm(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  std::string_view rest;
  const std::size_t size_at = content.find(size_key) + size_key.size();
  const auto header_size = leading_number(
      content.substr(size_at, 40).substr(0, content.substr(size_at, 40).find('\n')), rest);
  if (!header_size || !(*header_size >= double(size_at)) || *header_size > double(content.size()))
    bytes.fail("its header does not end within the file");
  const auto header_bytes = static_cast<std::size_t>(*header_size);
  std::map<std::string, std::string> keys;
  for_each_text_line(content.substr(0, header_bytes), [&](std::string_view line) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string_view::npos)
      keys[clean_text(line.substr(0, colon))] = clean_text(line.substr(colon + 1));
  });
  const auto quantity = [&](const char* key) {
    const auto found = keys.find(key);
    std::string_view unit;
    const auto value = found == keys.end() ? std::nullopt : leading_number(found->second, unit);
    if (!value) bytes.fail(fmt::format("its header does not say {}", key));
    return Quantity{*value, std::string(unit)};
  };
  const double width = quantity("Number of columns").value,
               height = quantity("Number of rows").value;
  const std::string kind = keys.contains("Image Data Type") ? keys["Image Data Type"] : "short";
  const SampleType type = kind == "double"  ? SampleType::float64
                          : kind == "float" ? SampleType::float32
                                            : SampleType::int16;
  check_scan_size(file, width, height, bytes_of(type), content.size());
  ScanChannel channel;
  channel.name = keys["Acquisition channel"];
  channel.width = static_cast<int>(width);
  channel.height = static_cast<int>(height);
  const Quantity x = quantity("X Amplitude"), y = quantity("Y Amplitude"),
                 z = quantity("Z Amplitude");
  const auto x_nm = scan_length_nm(x.unit), y_nm = scan_length_nm(y.unit);
  channel.pitch_guessed = !x_nm || !y_nm;
  channel.pitch_x_nm = std::abs(x.value) / width * x_nm.value_or(1);
  channel.pitch_y_nm = std::abs(y.value) / height * y_nm.value_or(1);
  channel.z_unit = z.unit;
  const Bytes data =
      bytes.part(header_bytes, static_cast<std::size_t>(width * height) * bytes_of(type));
  channel.values = [data, w = channel.width, h = channel.height, type, amplitude = z.value] {
    Grid<double> values = read_samples(data, w, h, {.type = type, .right_column_first = true});
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const double v : values.data()) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
    const double scale = high > low ? amplitude / (high - low) : 0;
    for (double& v : values.data()) v *= scale;
    return values;
  };
  for (const char* key : {"Number of columns", "Number of rows", "Image header size"})
    keys.erase(key);
  return {"WSxM", {std::move(channel)}, keys, {}};
}

}  // namespace surf::io
