// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include "files/damaged.h"
#include "image_formats.h"
#include "stored_pixels.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr std::uint16_t tag_width = 256;
constexpr std::uint16_t tag_height = 257;
constexpr std::uint16_t tag_bits = 258;
constexpr std::uint16_t tag_compression = 259;
constexpr std::uint16_t tag_colours = 262;
constexpr std::uint16_t tag_description = 270;
constexpr std::uint16_t tag_samples = 277;
constexpr std::uint16_t tag_tile_width = 322;
constexpr std::uint16_t tag_tile_height = 323;
constexpr std::uint16_t tag_strip_offsets = 273;
constexpr std::uint16_t tag_strip_bytes = 279;
constexpr std::uint16_t tag_tile_offsets = 324;
constexpr std::uint16_t tag_tile_bytes = 325;

/// How many times smaller a compression can make pixels.
double most_ratio(std::uint64_t compression) {
  switch (compression) {
    case 1:
      return 1;  // none
    case 5:
      return 1500;  // LZW: texts of up to 3837 bytes in 12 bits
    case 32773:
      return 64;  // PackBits: 128 bytes in 2
    case 8:
    case 32946:
      return deflate_ratio;
    default:
      return unknown_ratio;  // fax codes of white rows, Zstandard, LZMA
  }
}

/// Follows the directories of a TIFF or BigTIFF file and asks whether what they point at is there,
/// and whether all their pixels can be.
class TiffStructure {
 public:
  explicit TiffStructure(const std::filesystem::path& path)
      : path_(path), stream_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  void check() {
    const std::uint64_t byte_order = number(0, 2);
    big_endian_ = byte_order == 0x4d4d;
    big_ = number(2, 2) == 43;
    std::uint64_t directory = big_ ? number(8, 8) : number(4, 4);
    std::set<std::uint64_t> seen;
    while (directory != 0 && seen.insert(directory).second) directory = check_directory(directory);
    require_stored(path_.string(), pixel_bytes_, least_bytes_, size_);
  }

 private:
  struct Entry {
    std::uint64_t count = 0;
    std::uint64_t place = 0;  ///< of the values
    std::uint64_t bytes = 0;  ///< of one value
  };

  [[noreturn]] void fail(std::uint64_t offset) const {
    throw FileError(fmt::format("{}, byte {}", path_.string(), offset),
                    fmt::format("the file has only {} bytes", size_), copy_again);
  }

  void require(std::uint64_t offset, std::uint64_t bytes) const {
    if (offset > size_ || bytes > size_ - offset) fail(offset);
  }

  std::uint64_t number(std::uint64_t offset, std::uint64_t bytes) {
    require(offset, bytes);
    unsigned char buffer[8] = {};
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(buffer), static_cast<std::streamsize>(bytes));
    if (!stream_) fail(offset);
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < bytes; ++i) {
      value = value << 8 | buffer[big_endian_ ? i : bytes - 1 - i];
    }
    return value;
  }

  /// What a directory says of its image; the values are those where it says nothing.
  struct Pixels {
    double width = 0, height = 0, bits = 1, samples = 1, tile_width = 0, tile_height = 0;
    std::uint64_t compression = 1, colours = 0;

    /// Before they are compressed. Luminance and colours (6) may leave out most of the colours.
    double bytes() const {
      const double all = std::max(width * height, tile_width * tile_height) * samples * bits / 8;
      return colours == 6 ? all / 3 : all;
    }
  };

  std::uint64_t first(const Entry& entry) {
    return entry.count == 0 ? 0 : number(entry.place, entry.bytes);
  }

  /// Returns the offset of the next directory.
  std::uint64_t check_directory(std::uint64_t offset) {
    const std::uint64_t count_bytes = big_ ? 8 : 2;
    const std::uint64_t entry_bytes = big_ ? 20 : 12;
    const std::uint64_t count = number(offset, count_bytes);
    if (count > size_ / entry_bytes) fail(offset);
    Entry strip_offsets, strip_bytes, tile_offsets, tile_bytes;
    Pixels pixels;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t place = offset + count_bytes + i * entry_bytes;
      switch (number(place, 2)) {
        case tag_width:
          pixels.width = first(entry(place));
          break;
        case tag_height:
          pixels.height = first(entry(place));
          break;
        case tag_bits:
          pixels.bits = first(entry(place));
          break;
        case tag_compression:
          pixels.compression = first(entry(place));
          break;
        case tag_colours:
          pixels.colours = first(entry(place));
          break;
        case tag_samples:
          pixels.samples = first(entry(place));
          break;
        case tag_tile_width:
          pixels.tile_width = first(entry(place));
          break;
        case tag_tile_height:
          pixels.tile_height = first(entry(place));
          break;
        case tag_description:
          entry(place);
          break;
        case tag_strip_offsets:
          strip_offsets = entry(place);
          break;
        case tag_strip_bytes:
          strip_bytes = entry(place);
          break;
        case tag_tile_offsets:
          tile_offsets = entry(place);
          break;
        case tag_tile_bytes:
          tile_bytes = entry(place);
          break;
        default:
          break;
      }
    }
    check_blocks(strip_offsets, strip_bytes);
    check_blocks(tile_offsets, tile_bytes);
    pixel_bytes_ += pixels.bytes();
    least_bytes_ += pixels.bytes() / most_ratio(pixels.compression);
    return number(offset + count_bytes + count * entry_bytes, big_ ? 8 : 4);
  }

  /// The entry at `place`, whose values must lie in the file.
  Entry entry(std::uint64_t place) {
    const std::uint64_t room = big_ ? 8 : 4;
    const std::uint64_t type = number(place + 2, 2);
    Entry result;
    result.bytes = type == 3 ? 2 : type == 4 || type == 13 ? 4 : type >= 16 && type <= 18 ? 8 : 1;
    result.count = number(place + 4, room);
    if (result.count > size_) fail(place);
    result.place = place + 4 + room;
    if (result.count * result.bytes > room) result.place = number(result.place, room);
    require(result.place, result.count * result.bytes);
    return result;
  }

  void check_blocks(const Entry& offsets, const Entry& bytes) {
    if (offsets.count != bytes.count) return;  // libtiff has rules for these
    for (std::uint64_t i = 0; i < offsets.count; ++i) {
      require(number(offsets.place + i * offsets.bytes, offsets.bytes),
              number(bytes.place + i * bytes.bytes, bytes.bytes));
    }
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_;
  double pixel_bytes_ = 0;  // of all directories
  double least_bytes_ = 0;  // that they take in the file
  bool big_endian_ = false;
  bool big_ = false;
};

}  // namespace

void check_tiff_structure(const std::filesystem::path& path) { TiffStructure(path).check(); }

}  // namespace surf::io
