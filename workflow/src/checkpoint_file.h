// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace surf::workflow {

/// A file that grows by blocks, each with its SHA-256, so that a crash at any moment, or a damaged
/// disk, costs the blocks that it hits and no others. The first block says whose file it is. Held
/// by one process at a time (where the file system has locks).
///
/// A block: the 8 letters "semsurfB", its length (8 bytes, lowest first), the 64 hexadecimal digits
/// of the SHA-256 of its content, the content.
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

  /// Opens a file that is there; false where there is none. Finds its sound blocks.
  /// Throws FileError if it cannot be read and written, is in use, or is something else than one of
  /// these files: such a file is never touched.
  bool open(const std::filesystem::path& path);

  /// The first block of a file that may be another's, without a lock; empty if it has none.
  static std::string first_block(const std::filesystem::path& path);

  /// Makes a new, empty one. Throws FileError; also if there is a file by now.
  void create(const std::filesystem::path& path);

  bool is_open() const { return file_ >= 0; }
  bool empty() const { return end_ == 0; }
  const std::filesystem::path& path() const { return path_; }

  /// Sound blocks, in the file's order, and whether some were not.
  const std::vector<Block>& blocks() const { return blocks_; }
  bool damaged() const { return damaged_; }

  /// The content of a block. Throws FileError.
  std::string read(const Block& block) const;

  /// Adds a block and sees it onto the disk. Throws FileError, and leaves the file as it was: later
  /// blocks may succeed.
  void append(const std::string& content);

  /// Back to an empty file.
  void clear();

  /// Deletes the file.
  void remove();

 private:
  void lock();
  void find_blocks();
  void close();

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t end_ = 0;  // behind the last sound block
  std::vector<Block> blocks_;
  bool damaged_ = false;
};

}  // namespace surf::workflow
