// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view tag = "semsurfB";
constexpr std::size_t digits = 64;
constexpr std::size_t head_size = tag.size() + 8 + digits;

std::string sha256(const std::string& text) {
  return io::sha256_of(std::as_bytes(std::span(text)));
}

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw FileError(
      path.string(), reason,
      "Check its folder and the free space, choose another place by `job.checkpoint=FILE`, or "
      "do without by `job.checkpoint=off`");
}

std::string head_of(const std::string& content) {
  std::string head(tag);
  for (int shift = 0; shift < 64; shift += 8)
    head.push_back(static_cast<char>(std::uint64_t{content.size()} >> shift));
  return head + sha256(content);
}

// Reads the size from a block's head; 0 if it is not a head.
std::uint64_t size_in(const std::string& head) {
  if (!head.starts_with(tag)) return 0;
  std::uint64_t size = 0;
  for (std::size_t i = 0; i < 8; ++i)
    size |= std::uint64_t{static_cast<unsigned char>(head[tag.size() + i])} << (8 * i);
  return size;
}

// Reads up to `size` bytes, fewer at the file's end. Returns false on errors.
bool read_at(int file, std::uint64_t offset, std::size_t size, std::string& out) {
  out.resize(size);
  std::size_t done = 0;
  while (done < size) {
    const auto n = ::pread(file, out.data() + done, size - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  out.resize(done);
  return true;
}

bool write_at(int file, std::uint64_t offset, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto n =
        ::pwrite(file, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

bool flush(int file) { return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP; }

}  // namespace

CheckpointFile::~CheckpointFile() { close(); }

void CheckpointFile::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

bool CheckpointFile::open(const fs::path& path) {
  close();
  path_ = path;
  file_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) {
    if (errno == ENOENT || errno == ENOTDIR) return false;
    fail(path, std::string("it cannot be opened to go on from: ") + std::strerror(errno));
  }
  struct stat status {};
  if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close();
    fail(path, "it is not an ordinary file");
  }
  lock();
  find_blocks();
  return true;
}

std::string CheckpointFile::first_block(const fs::path& path) {
  constexpr std::uint64_t most = std::uint64_t{1} << 24;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return {};
  std::string head, content;
  if (read_at(file, 0, head_size, head) && head.size() == head_size && size_in(head) <= most)
    read_at(file, head_size, size_in(head), content);
  ::close(file);
  return content.empty() || sha256(content) != head.substr(head_size - digits) ? std::string()
                                                                               : content;
}

void CheckpointFile::create(const fs::path& path) {
  close();
  path_ = path;
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path, std::string("it cannot be written: ") + std::strerror(errno));
  lock();
  end_ = 0;
  blocks_.clear();
  damaged_ = false;
}

void CheckpointFile::lock() {
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close();
  throw FileError(path_.string(), "another semsurf is working on the same job",
                  "Wait until it is done, or give `job.checkpoint=off` to do the work twice");
}

void CheckpointFile::find_blocks() {
  blocks_.clear();
  damaged_ = false;
  end_ = 0;
  std::string head, content;
  const auto fail_reading = [&] {
    fail(path_, std::string("it cannot be read: ") + std::strerror(errno));
  };
  struct stat status {};
  if (::fstat(file_, &status) != 0) fail_reading();
  const auto file_size = static_cast<std::uint64_t>(status.st_size);
  std::uint64_t offset = 0;
  for (;;) {
    if (!read_at(file_, offset, head_size, head)) fail_reading();
    if (offset == 0 && !head.empty() &&
        !tag.starts_with(std::string_view(head).substr(0, tag.size()))) {
      close();
      throw FileError(path_.string(), "it is not a checkpoint of semsurf, and is left alone",
                      "Choose another name by `job.checkpoint=FILE`");
    }
    const std::uint64_t size = head.size() == head_size ? size_in(head) : 0;
    if (size == 0 || size > file_size - offset - head_size) break;
    if (!read_at(file_, offset + head_size, size, content)) fail_reading();
    offset += head_size + size;
    if (content.size() == size && sha256(content) == head.substr(head_size - digits)) {
      blocks_.push_back({offset - size, size});
      end_ = offset;
    } else {
      damaged_ = true;  // a wrong length shows up where the next block should begin
      if (blocks_.empty()) break;
    }
  }
  damaged_ = damaged_ || end_ != file_size;
}

std::string CheckpointFile::read(const Block& block) const {
  std::string content;
  if (!read_at(file_, block.offset, block.size, content) || content.size() != block.size)
    fail(path_, "it cannot be read any more");
  return content;
}

void CheckpointFile::append(const std::string& content) {
  // Bytes after the end are damaged, and may be longer than the new block.
  const bool done = ::ftruncate(file_, static_cast<off_t>(end_)) == 0 &&
                    write_at(file_, end_, head_of(content)) &&
                    write_at(file_, end_ + head_size, content) && flush(file_);
  if (!done) {
    const std::string reason = std::strerror(errno);
    [[maybe_unused]] const int ignored = ::ftruncate(file_, static_cast<off_t>(end_));
    fail(path_, "it cannot be written: " + reason);
  }
  end_ += head_size + content.size();
}

void CheckpointFile::clear() {
  if (::ftruncate(file_, 0) != 0)
    fail(path_, std::string("it cannot be emptied: ") + std::strerror(errno));
  end_ = 0;
  blocks_.clear();
  damaged_ = false;
}

void CheckpointFile::remove() {
  std::error_code ignored;
  fs::remove(path_, ignored);
  close();
}

}  // namespace surf::workflow
