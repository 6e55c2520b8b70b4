// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

// The file of one cache entry. All numbers have their lowest byte first.
//
//   byte  0  magic, 16 bytes
//        16  version of this layout, 4 bytes
//        20  length of the key, 4 bytes
//        24  length of the payload, 8 bytes
//        32  checksum, 16 bytes: XXH3 of bytes 0 to 31, the key and the payload
//        48  key, then payload, then the end

namespace surf::io {

/// An open file, closed by the destructor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int file = -1) : file_(file) {}
  FileDescriptor(FileDescriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~FileDescriptor();

  int get() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }

 private:
  int file_;
};

/// The part read of an entry. `fault` describes what is wrong with the entry; empty if nothing is.
struct EntryContent {
  std::string key;
  std::vector<std::byte> payload;  ///< only if requested
  std::string fault;
};

enum class EntryPart { header, checked, payload };

/// Opens an entry for reading. The result is empty if the entry is missing or not an ordinary file.
FileDescriptor open_entry(const std::filesystem::path& path);

/// Reads an entry from its start: only magic, lengths and key (`header`), the whole entry without
/// keeping the payload (`checked`), or the whole entry (`payload`).
EntryContent read_entry(const FileDescriptor& file, EntryPart part);

/// Writes an entry to a file. Throws std::system_error.
void write_entry(const std::filesystem::path& path, const std::string& key,
                 std::span<const std::byte> payload);

}  // namespace surf::io
