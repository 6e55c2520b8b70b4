// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// Writes a ZIP archive (PKWARE's APPNOTE 6.3) in memory, the container of 3MF and other packages.
/// Equal parts give equal bytes: all are dated 1980.
class ZipWriter {
 public:
  /// `file` is the name for messages.
  explicit ZipWriter(std::string file);
  ~ZipWriter();

  /// Begins a part. `append` adds its content in any number of pieces, which are compressed at
  /// once.
  void begin(const std::string& name);
  void append(std::string_view piece);
  /// Ends the archive and returns it. Throws InvalidInput for parts beyond 4 GB.
  std::string finish();

 private:
  struct Part;
  struct Packer;

  void end_part();
  void pack(std::string_view piece, bool is_last);

  std::string file_;
  std::string content_;
  std::vector<Part> parts_;
  std::unique_ptr<Packer> packer_;
};

/// The parts of a ZIP archive. `content` must outlive this.
class ZipReader {
 public:
  /// Throws FileError if the content is not an archive or is damaged.
  ZipReader(std::string file, std::string_view content);

  std::vector<std::string> names() const;
  /// The unpacked and checked part of that name (case does not matter), or nothing if there is
  /// none. Throws FileError, also for parts that unpack to an absurd size, and Unsupported.
  std::optional<std::string> read(std::string_view name) const;

 private:
  struct Entry {
    std::string name;
    std::uint32_t method = 0, flags = 0, checksum = 0;
    std::uint64_t packed = 0, size = 0, offset = 0;
  };

  [[noreturn]] void fail(const std::string& reason) const;
  std::uint64_t number(std::uint64_t position, int bytes) const;
  void read_directory(std::uint64_t position, std::uint64_t entries);
  void apply_large(Entry& entry, std::uint64_t position, std::uint64_t end) const;
  std::string unpack(const Entry& entry, std::string_view packed) const;

  std::string file_;
  std::string_view content_;
  std::vector<Entry> entries_;
};

}  // namespace surf::io
