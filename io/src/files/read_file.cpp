// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "sha256.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pipe_bytes = std::size_t{512} << 20;  // its size is not known before

using FilePointer = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Throws for what is neither an ordinary file nor a pipe without a name, such as the shell's
/// <(command): a device may never end, and a pipe with a name may never begin.
fs::file_type readable_type(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    if (error && error != std::errc::no_such_file_or_directory &&
        error != std::errc::not_a_directory) {
      throw FileError(path.string(), fmt::format("it cannot be found: {}", error.message()),
                      "Check its folder and links");
    }
    throw FileError(path.string(), "there is no such file", "Check the name and the folder");
  }
  switch (status.type()) {
    case fs::file_type::regular:
      return fs::file_type::regular;
    case fs::file_type::directory:
      throw FileError(path.string(), "this is a folder", "Name a file in it");
    case fs::file_type::fifo: {
      struct statfs system {};
      if (::statfs(path.c_str(), &system) == 0 && system.f_type == PIPEFS_MAGIC)
        return fs::file_type::fifo;
      throw FileError(path.string(), "this is a named pipe",
                      "Name an ordinary file, or write <(command) in the shell");
    }
    case fs::file_type::character:
    case fs::file_type::block:
      throw FileError(path.string(), "this is a device", "Name an ordinary file");
    default:
      throw FileError(path.string(), "this is not an ordinary file", "Name an ordinary file");
  }
}

FilePointer open_for_reading(const fs::path& path) {
  FilePointer file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    throw FileError(path.string(), fmt::format("it cannot be opened: {}", std::strerror(errno)),
                    "Check its permissions");
  }
  return file;
}

std::string size_text(std::size_t bytes) {
  return bytes < 1000         ? fmt::format("{} bytes", bytes)
         : bytes < 1000000    ? fmt::format("{:.3g} kB", 1e-3 * double(bytes))
         : bytes < 1000000000 ? fmt::format("{:.3g} MB", 1e-6 * double(bytes))
                              : fmt::format("{:.3g} GB", 1e-9 * double(bytes));
}

[[noreturn]] void fail_size(const fs::path& path, std::size_t max_bytes) {
  throw FileError(
      path.string(),
      fmt::format("it has more than {}, which is the most that is read here", size_text(max_bytes)),
      "Give a smaller file");
}

/// SHA-256 of what came through pipes, for records: a pipe gives its bytes only once.
class PipeHashes {
 public:
  void put(const std::FILE* file, std::string hash) {
    const std::lock_guard lock(mutex_);
    hashes_[key_of(file)] = std::move(hash);
  }
  std::optional<std::string> find(const std::FILE* file) {
    const std::lock_guard lock(mutex_);
    const auto found = hashes_.find(key_of(file));
    return found == hashes_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  using Key = std::pair<dev_t, ino_t>;
  static Key key_of(const std::FILE* file) {
    struct stat status {};
    ::fstat(::fileno(const_cast<std::FILE*>(file)), &status);
    return {status.st_dev, status.st_ino};
  }

  std::mutex mutex_;
  std::map<Key, std::string> hashes_;
};

PipeHashes& pipe_hashes() {
  static PipeHashes hashes;
  return hashes;
}

[[noreturn]] void fail_reading(const fs::path& path) {
  throw FileError(path.string(), fmt::format("reading failed: {}", std::strerror(errno)),
                  "Check the disk or copy the file again");
}

}  // namespace

void require_regular_file(const fs::path& path) {
  if (readable_type(path) == fs::file_type::regular) return;
  throw FileError(path.string(), "this is a pipe, and its bytes are needed more than once",
                  "Write them to a file first");
}

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  const bool is_pipe = readable_type(path) == fs::file_type::fifo;
  if (is_pipe) max_bytes = std::min(max_bytes, most_pipe_bytes);
  const FilePointer file = open_for_reading(path);
  std::string text;
  std::error_code error;
  if (!is_pipe) {
    const auto size = fs::file_size(path, error);
    if (!error && size > max_bytes) fail_size(path, max_bytes);
    if (!error) text.reserve(size + 1);
  }
  std::size_t used = 0;
  for (;;) {
    // One byte more than the capacity holds would allocate twice the size of a large file.
    const std::size_t room = text.capacity() - used;
    text.resize(used + (room > 0 ? room : std::size_t{1} << 16));
    const std::size_t read = std::fread(text.data() + used, 1, text.size() - used, file.get());
    used += read;
    text.resize(used);
    if (used > max_bytes) fail_size(path, max_bytes);
    if (read == 0) break;
  }
  if (std::ferror(file.get())) fail_reading(path);
  if (is_pipe && text.empty() && pipe_hashes().find(file.get()))
    require_regular_file(path);  // it was read before
  if (is_pipe && !text.empty())
    pipe_hashes().put(file.get(), sha256_of(std::as_bytes(std::span(text))));
  return text;
}

std::string sha256_of_file(const fs::path& path) {
  const bool is_pipe = readable_type(path) == fs::file_type::fifo;
  const FilePointer file = open_for_reading(path);
  if (is_pipe) {
    if (auto known = pipe_hashes().find(file.get())) return *known;
    require_regular_file(path);
  }
  Sha256 hash;
  std::string buffer(std::size_t{1} << 20, '\0');
  while (const std::size_t read = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    hash.add(buffer.data(), read);
  }
  if (std::ferror(file.get())) fail_reading(path);
  return hash.hexadecimal();
}

}  // namespace surf::io
