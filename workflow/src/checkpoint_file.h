// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace surf::workflow {

/// A file that grows by blocks, each with its SHA-256. A crash at any moment or a damaged disk
/// costs only the blocks that it hits. The first block identifies the job. One process at a time
/// holds the file (if the file system has locks).
///
/// A block consists of the 8 letters "semsurfB", its length (8 bytes, lowest first), the 64
/// hexadecimal digits of the SHA-256 of its content, and the content.
class CheckpointFile {
 public:
  struct Block {
    std::uint64_t offset = 0;  ///< of its content
    std::uint64_t size = 0;
  };

  CheckpointFile() = default;
  ~CheckpointFile();
  CheckpointFile(const CheckpointFile&) = delete;
  CheckpointFile& operator=(const CheckpointFile&) = delete;

  /// Opens an existing file and finds its sound blocks. Returns false if there is no file. Throws
  /// FileError if the file cannot be read and written, is in use, or is not a checkpoint file.
  /// Other files are never touched.
  bool open(const std::filesystem::path& path);

  /// The first block of a file, which may belong to another job; reads it without a lock. Empty if
  /// there is none.
  static std::string first_block(const std::filesystem::path& path);

  /// Creates an empty file. Throws FileError, also if the file exists by now.
  void create(const std::filesystem::path& path);

  bool is_open() const { return file_ >= 0; }
  bool empty() const { return end_ == 0; }
  const std::filesystem::path& path() const { return path_; }

  /// The sound blocks, in the file's order. `damaged` says whether there were others.
  const std::vector<Block>& blocks() const { return blocks_; }
  bool damaged() const { return damaged_; }

  /// The content of a block. Throws FileError.
  std::string read(const Block& block) const;

  /// Appends a block and waits until it is on the disk. Throws FileError and leaves the file
  /// unchanged; later blocks may succeed.
  void append(const std::string& content);

  /// Empties the file.
  void clear();

  /// Deletes the file.
  void remove();

 private:
  void lock();
  void find_blocks();
  void close();

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t end_ = 0;  // end of the last sound block
  std::vector<Block> blocks_;
  bool damaged_ = false;
};

}  // namespace surf::workflow
