// SPDX-License-Identifier: GPL-3.0-or-later
// Park Systems (PSIA) TIFF: the picture is for viewers; the samples lie in tag 50434, the lowest
// row first, what they mean in the header of tag 50435. Height = gain * sample; gains may be
// negative.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "files/damaged.h"
#include "samples.h"
#include "scan_formats.h"
#include "tiff_tags.h"

namespace surf::io {
namespace {

constexpr int magic_tag = 50432, version_tag = 50433, data_tag = 50434, header_tag = 50435;
constexpr double magic = 0x0E031301, first_with_type = 0x01000002;

// Offsets in the header.
constexpr std::size_t name_at = 4, name_bytes = 64, mode_at = 68, mode_bytes = 16, width_at = 100,
                      height_at = 104, size_x_at = 140, size_y_at = 148, gain_at = 220,
                      scale_at = 228, zero_at = 236, unit_at = 244, unit_bytes = 16, type_at = 348;

/// UTF-16LE up to a NUL; what is not Latin-1 becomes "?", but the Greek mu is u.
std::string wide_text(const Bytes& header, std::size_t at, std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    const auto c = header.little<std::uint16_t>(at + i);
    if (c == 0) break;
    text += c == 0x3BC || c == 0xB5 ? 'u' : c < 0x80 ? static_cast<char>(c) : '?';
  }
  return clean_text(text);
}

SampleType sample_type(const Bytes& header, double version) {
  const auto type = version >= first_with_type ? header.little<std::int32_t>(type_at) : 0;
  switch (type) {
    case 0:
      return SampleType::int16;
    case 1:
      return SampleType::int32;
    case 2:
      return SampleType::float32;
    default:
      header.fail(fmt::format("its numbers are of the unknown kind {}", type));
  }
}

}  // namespace

bool is_park_tiff(std::string_view content) {
  if (!is_tiff(content)) return false;
  // The mark's tag, number and value as they stand in a directory.
  std::string entry("\x00\xC5\x04\x00\x01\x00\x00\x00\x01\x13\x03\x0E", 12);
  return content.find(entry) != std::string_view::npos;
}

Scan parse_park(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const auto pages = parse_tiff_pages(bytes);
  if (pages.empty()) bytes.fail("it has no page");
  const TiffPage& page = pages.front();
  const TiffTag *const data = page.find(data_tag), *const header_value = page.find(header_tag);
  if (page.number(magic_tag) != magic || !data || !header_value)
    bytes.fail("its samples or their header are missing", copy_again);
  const Bytes& header = header_value->bytes();
  const double version = page.number(version_tag).value_or(0);
  const auto width = header.little<std::int32_t>(width_at),
             height = header.little<std::int32_t>(height_at);
  const SampleType type = sample_type(header, version);
  check_scan_size(file, width, height, bytes_of(type), data->bytes().size());
  ScanChannel channel;
  channel.name = wide_text(header, name_at, name_bytes);
  channel.z_unit = wide_text(header, unit_at, unit_bytes);
  channel.width = width;
  channel.height = height;
  channel.pitch_x_nm = std::abs(header.little<double>(size_x_at)) / width * 1e3;  // um
  channel.pitch_y_nm = std::abs(header.little<double>(size_y_at)) / height * 1e3;
  const double scale = header.little<double>(scale_at);
  const double factor = header.little<double>(gain_at) * (scale == 0 ? 1 : scale);
  const SampleLayout layout{
      .type = type, .scale = factor, .offset = header.little<double>(zero_at)};
  channel.values = [samples = data->bytes(), width, height, layout] {
    return read_samples(samples, width, height, layout);
  };
  Scan scan{"Park Systems", {std::move(channel)}, {}, {}};
  if (const std::string mode = wide_text(header, mode_at, mode_bytes); !mode.empty())
    scan.metadata["mode"] = mode;
  constexpr int software_tag = 305, date_tag = 306;
  if (const std::string text = page.text(software_tag); !text.empty())
    scan.metadata["software"] = text;
  if (const std::string text = page.text(date_tag); !text.empty()) scan.metadata["date"] = text;
  return scan;
}

}  // namespace surf::io
