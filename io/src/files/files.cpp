// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "surf/core/error.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* temporary_start = ".semsurf-";
constexpr const char* temporary_end = ".tmp";
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
      throw FileError(path.string(), fmt::format("cannot be found: {}", error.message()),
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
    throw FileError(path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)),
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
      fmt::format("has more than {}, which is the most that is read here", size_text(max_bytes)),
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

[[noreturn]] void fail_writing(const fs::path& path, const std::string& reason) {
  throw FileError(path.string(), fmt::format("cannot be written: {}", reason),
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

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    check(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const void* data, std::size_t size) {
    check(EVP_DigestUpdate(context_.get(), data, size) == 1);
  }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  static void check(bool done) {
    if (!done) {
      throw Unsupported("SHA-256", "OpenSSL refuses to compute it", "Check its configuration");
    }
  }

  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

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

std::string sha256_of(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hexadecimal();
}

}  // namespace surf::io
