// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include "image_formats.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr std::uint16_t tag_description = 270;
constexpr std::uint16_t tag_strip_offsets = 273;
constexpr std::uint16_t tag_strip_bytes = 279;
constexpr std::uint16_t tag_tile_offsets = 324;
constexpr std::uint16_t tag_tile_bytes = 325;

/// Follows the directories of a TIFF or BigTIFF file and asks whether what they point at is there.
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
  }

 private:
  struct Entry {
    std::uint64_t count = 0;
    std::uint64_t place = 0;   ///< of the values
    std::uint64_t bytes = 0;   ///< of one value
  };

  [[noreturn]] void fail(std::uint64_t offset) const {
    throw FileError(fmt::format("{}, byte {}", path_.string(), offset),
                    fmt::format("the file has only {} bytes", size_),
                    "It is cut off or damaged: copy or write it again");
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

  /// Returns the offset of the next directory.
  std::uint64_t check_directory(std::uint64_t offset) {
    const std::uint64_t count_bytes = big_ ? 8 : 2;
    const std::uint64_t entry_bytes = big_ ? 20 : 12;
    const std::uint64_t count = number(offset, count_bytes);
    if (count > size_ / entry_bytes) fail(offset);
    Entry strip_offsets, strip_bytes, tile_offsets, tile_bytes;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t place = offset + count_bytes + i * entry_bytes;
      switch (number(place, 2)) {
        case tag_description: entry(place); break;
        case tag_strip_offsets: strip_offsets = entry(place); break;
        case tag_strip_bytes: strip_bytes = entry(place); break;
        case tag_tile_offsets: tile_offsets = entry(place); break;
        case tag_tile_bytes: tile_bytes = entry(place); break;
        default: break;
      }
    }
    check_blocks(strip_offsets, strip_bytes);
    check_blocks(tile_offsets, tile_bytes);
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
    if (offsets.count != bytes.count) return;   // libtiff has rules for these
    for (std::uint64_t i = 0; i < offsets.count; ++i) {
      require(number(offsets.place + i * offsets.bytes, offsets.bytes),
              number(bytes.place + i * bytes.bytes, bytes.bytes));
    }
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_;
  bool big_endian_ = false;
  bool big_ = false;
};

}  // namespace

void check_tiff_structure(const std::filesystem::path& path) { TiffStructure(path).check(); }

}  // namespace surf::io
