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

/// A ZIP archive (PKWARE's APPNOTE 6.3) in memory, as 3MF and other packages are. The same parts
/// give the same bytes: all are dated 1980.
class ZipWriter {
 public:
  /// `file` is the name for messages.
  explicit ZipWriter(std::string file);
  ~ZipWriter();

  /// Begins a part; `append` gives its content, in as many pieces as convenient, which are packed
  /// as they come.
  void begin(const std::string& name);
  void append(std::string_view piece);
  /// Ends the archive and gives it away. Throws InvalidInput for parts beyond 4 GB.
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
  /// Throws FileError for what is no archive or is damaged.
  ZipReader(std::string file, std::string_view content);

  std::vector<std::string> names() const;
  /// The part of that name (letters of either case), unpacked and checked; nothing where there is
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
