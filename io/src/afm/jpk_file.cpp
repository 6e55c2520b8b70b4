// SPDX-License-Identifier: GPL-3.0-or-later
// JPK images (.jpk, .jpk-qi-image): TIFF with a small picture and then a page per channel, the
// lowest row first. A page has "slots", one calibration built upon another; the default slot says
// unit, factor and offset of the stored numbers. Factors of heights may be negative.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "samples.h"
#include "scan_formats.h"
#include "surf/core/error.h"
#include "tiff_tags.h"

namespace surf::io {
namespace {

constexpr int size_x_tag = 0x8042, size_y_tag = 0x8043;  // of the first page, in m
constexpr int short_name_tag = 0x8050, retrace_tag = 0x8051, name_tag = 0x8052;
constexpr int slots_tag = 0x8080, default_slot_tag = 0x8081, first_slot = 0x8090, slot_step = 0x30;
// From a slot's first tag, its name.
constexpr int unit_step = 0x12, scaling_step = 0x13, factor_step = 0x14, offset_step = 0x15;
constexpr int width_tag = 0x100, height_tag = 0x101, bits_tag = 0x102, compression_tag = 0x103,
              strips_tag = 0x111, strip_bytes_tag = 0x117, samples_tag = 0x115, kind_tag = 0x153;

struct Calibration {
  std::string unit;
  double factor = 1, offset = 0;
};

Calibration calibration_of(const Bytes& bytes, const TiffPage& page) {
  constexpr int most_slots = 64;
  const std::string wanted = page.text(default_slot_tag);
  const int slots = static_cast<int>(
      std::min(std::max(page.number(slots_tag).value_or(0), 0.0), double(most_slots)));
  for (int slot = 0; slot < slots; ++slot) {
    const int first = first_slot + slot * slot_step;
    if (page.text(first) != wanted) continue;
    Calibration calibration;
    calibration.unit = page.text(first + unit_step);
    if (page.text(first + scaling_step) != "LinearScaling") return calibration;
    const auto factor = page.number(first + factor_step), offset = page.number(first + offset_step);
    if (!factor || !offset)
      bytes.fail(fmt::format("the calibration '{}' of a channel has no numbers", wanted));
    calibration.factor = *factor;
    calibration.offset = *offset;
    return calibration;
  }
  bytes.fail(fmt::format("the calibration '{}' of a channel is not there", wanted));
}

SampleType sample_type(const Bytes& bytes, const TiffPage& page) {
  const double bits = page.number(bits_tag).value_or(0);
  const double kind = page.number(kind_tag).value_or(1);  // 1 unsigned, 2 signed, 3 floating
  if (kind == 3 && bits == 32) return SampleType::float32;
  if (kind == 3 && bits == 64) return SampleType::float64;
  if (bits == 16) return kind == 2 ? SampleType::int16 : SampleType::uint16;
  if (bits == 32) return kind == 2 ? SampleType::int32 : SampleType::uint32;
  bytes.fail(fmt::format("a channel has numbers of {} bits of kind {}", bits, kind),
             "Export it as .gwy or text");
}

/// The strips of a page joined.
std::shared_ptr<const std::string> joined_strips(const Bytes& bytes, const TiffPage& page) {
  const TiffTag *const strips = page.find(strips_tag), *const sizes = page.find(strip_bytes_tag);
  if (!strips || !sizes || strips->count() != sizes->count())
    bytes.fail("a channel's samples are missing");
  std::string all;
  for (std::size_t i = 0; i < strips->count(); ++i) {
    const auto at = strips->whole(i), size = sizes->whole(i);
    if (!at || !size) bytes.fail("a channel's samples are missing");
    if (*size > bytes.size() - std::min(all.size(), bytes.size()))
      bytes.fail("a channel is larger than the file");
    all += bytes.part(*at, *size).text();
  }
  return std::make_shared<const std::string>(std::move(all));
}

}  // namespace

bool is_jpk(std::string_view content) {
  // A file's first page names JPK's version, tag 0x8000, and the size of the scan, 0x8042.
  if (!is_tiff(content)) return false;
  const bool big = tiff_order(content) == std::endian::big;
  const std::string_view size_entry = big ? std::string_view("\x80\x42\x00\x0C\x00\x00\x00\x01", 8)
                                          : std::string_view("\x42\x80\x0C\x00\x01\x00\x00\x00", 8);
  return content.find(size_entry) != std::string_view::npos;
}

Scan parse_jpk(const std::string& file, std::string_view content) {
  const Bytes bytes(file, content);
  const auto pages = parse_tiff_pages(bytes);
  if (pages.size() < 2) bytes.fail("it has no channel");
  const auto size_x = pages.front().number(size_x_tag), size_y = pages.front().number(size_y_tag);
  if (!size_x || !size_y) bytes.fail("it does not say its size");
  Scan scan{"JPK", {}, {}, {}};
  for (const auto& [tag, key] : {std::pair{0x8000, "version"}, {0x8003, "date"}, {0x8050, "mode"}})
    if (const std::string text = pages.front().text(tag); !text.empty() && text != "<empty>")
      scan.metadata[key] = text;
  for (std::size_t i = 1; i < pages.size(); ++i) {
    const TiffPage& page = pages[i];
    const double width = page.number(width_tag).value_or(0),
                 height = page.number(height_tag).value_or(0);
    if (page.number(compression_tag).value_or(1) != 1 || page.number(samples_tag).value_or(1) != 1)
      throw Unsupported(file, "its channels are compressed or in colour",
                        "Export it as .gwy, .gsf or text");
    const SampleType type = sample_type(bytes, page);
    check_scan_size(file, width, height, bytes_of(type), content.size());
    const Calibration calibration = calibration_of(bytes, page);
    ScanChannel channel;
    channel.name = page.text(name_tag).empty() ? page.text(short_name_tag) : page.text(name_tag);
    channel.z_unit = calibration.unit;
    channel.width = static_cast<int>(width);
    channel.height = static_cast<int>(height);
    channel.pitch_x_nm = std::abs(*size_x) / width * 1e9;  // m
    channel.pitch_y_nm = std::abs(*size_y) / height * 1e9;
    channel.metadata["line direction"] =
        page.number(retrace_tag).value_or(0) != 0 ? "retrace" : "trace";
    const SampleLayout layout{.type = type,
                              .order = tiff_order(content),
                              .scale = calibration.factor,
                              .offset = calibration.offset};
    channel.values = [bytes, page, w = channel.width, h = channel.height, layout] {
      const auto samples = joined_strips(bytes, page);
      return read_samples(Bytes(bytes.file(), *samples), w, h, layout);
    };
    scan.channels.push_back(std::move(channel));
  }
  return scan;
}

}  // namespace surf::io
