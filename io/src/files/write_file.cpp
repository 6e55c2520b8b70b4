// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* temporary_start = ".semsurf-";
constexpr const char* temporary_end = ".tmp";

using FilePointer = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail_writing(const fs::path& path, const std::string& reason) {
  throw FileError(path.string(), fmt::format("it cannot be written: {}", reason),
                  "Check the folder, its permissions and the free space, or choose another place");
}

/// Where a write to `path` goes: links are followed, so that they stay links.
fs::path resolve_target(const fs::path& path) {
  std::error_code error;
  fs::path target = path;
  if (fs::is_symlink(fs::symlink_status(path, error))) target = fs::weakly_canonical(path, error);
  if (target.empty() || !target.has_filename()) {
    fail_writing(path, "the name of a file is missing");
  }
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) fail_writing(path, "this is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail_writing(path, "this is not an ordinary file");
  }
  return target;
}

void create_parent_folders(const fs::path& path, const fs::path& target) {
  if (!target.has_parent_path()) return;
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  const std::string reason = error.message();
  if (error && !fs::is_directory(target.parent_path(), error)) {
    fail_writing(path, fmt::format("its folder cannot be created ({})", reason));
  }
}

/// An empty file of our own beside the target, removed at the end of the scope.
class Temporary {
 public:
  Temporary(const fs::path& path, const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 1000; ++attempt) {
      name_ = target.parent_path() /
              fmt::format("{}{}-{}{}", temporary_start, ::getpid(), counter++, temporary_end);
      const int file = ::open(name_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
      if (file >= 0) {
        ::close(file);
        return;
      }
      if (errno != EEXIST) break;
    }
    const std::string reason = std::strerror(errno);
    name_.clear();
    fail_writing(path, reason);
  }
  ~Temporary() {
    std::error_code ignored;
    if (!name_.empty()) fs::remove(name_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const fs::path& name() const { return name_; }

  void rename_to(const fs::path& path, const fs::path& target) {
    flush_to_disk(path);
    std::error_code error;
    fs::rename(name_, target, error);
    if (error) fail_writing(path, error.message());
    name_.clear();
  }

 private:
  // Without this a power cut after the rename could leave an empty file under the real name.
  void flush_to_disk(const fs::path& path) const {
    const int file = ::open(name_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool done = file >= 0 && (::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP);
    const std::string reason = std::strerror(errno);
    if (file >= 0) ::close(file);
    if (!done) fail_writing(path, reason);
  }

  fs::path name_;
};

}  // namespace

void write_atomically(const fs::path& path,
                      const std::function<void(const fs::path& temporary)>& write) {
  const fs::path target = resolve_target(path);
  create_parent_folders(path, target);
  Temporary temporary(path, target);
  try {
    write(temporary.name());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    fail_writing(path, error.what());
  }
  temporary.rename_to(path, target);
}

bool is_temporary_name(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(temporary_start) && name.ends_with(temporary_end);
}

void write_text(const fs::path& path, const std::string& text) {
  write_atomically(path, [&](const fs::path& temporary) {
    FilePointer file(std::fopen(temporary.c_str(), "wb"), &std::fclose);
    if (!file) fail_writing(path, std::strerror(errno));
    const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
    if (!written || std::fclose(file.release()) != 0) fail_writing(path, std::strerror(errno));
  });
}

void check_writable(const fs::path& path) {
  const fs::path target = resolve_target(path);
  create_parent_folders(path, target);
  const Temporary probe(path, target);
}

}  // namespace surf::io
