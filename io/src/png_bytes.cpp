// SPDX-License-Identifier: GPL-3.0-or-later
#include "png_bytes.h"

#include <string_view>

#include "deflate.h"

namespace surf::io {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

std::string chunk(std::string_view kind, std::string_view data) {
  const std::string body = std::string(kind) + std::string(data);
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc_of(body));
}

}  // namespace

std::string png_bytes(const Grid<std::uint8_t>& grey) {
  const auto width = static_cast<std::size_t>(grey.width());
  std::string rows;
  rows.reserve(grey.size() + static_cast<std::size_t>(grey.height()));
  constexpr char differences_to_the_left = 1;
  for (int y = grey.height() - 1; y >= 0; --y) {
    rows += differences_to_the_left;
    const std::uint8_t* const row = grey.data().data() + static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) rows += static_cast<char>(row[x] - (x > 0 ? row[x - 1] : 0));
  }
  const std::string eight_bits_of_grey{8, 0, 0, 0, 0};
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(static_cast<std::uint32_t>(grey.width())) +
                           big_endian(static_cast<std::uint32_t>(grey.height())) + eight_bits_of_grey) +
         chunk("IDAT", deflate(rows)) + chunk("IEND", {});
}

}  // namespace surf::io
