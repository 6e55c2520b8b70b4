// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/cache.h"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "cache_entry.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* extension = ".cache";
constexpr std::size_t hash_size = 64;  ///< hexadecimal digits of a SHA-256
constexpr std::size_t max_locks = 64;

std::string name_of(const std::string& key) {
  return sha256_of(std::as_bytes(std::span(key))) + extension;
}

/// Only what a cache may have written is ever listed or removed.
bool is_entry_name(const fs::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == extension && stem.size() == hash_size &&
         stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Independent of the current folder, without a slash at the end.
fs::path whole_path(const fs::path& folder) {
  std::error_code error;
  if (folder.empty()) return folder;
  const fs::path path = fs::absolute(folder, error).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

void check_key(const std::string& key) {
  if (!key.empty() && key.size() <= Cache::max_key_bytes) return;
  throw InvalidInput("cache", fmt::format("a key of {} bytes cannot be used", key.size()),
                     fmt::format("Give 1 to {} bytes", Cache::max_key_bytes));
}

/// Whether a living Cache, of this or another process, holds the entry.
bool is_locked(const fs::path& path) {
  const FileDescriptor file = open_entry(path);
  return file && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

bool is_left_behind(const fs::directory_entry& file) {
  std::error_code error;
  if (!is_temporary_name(file.path()) || !file.is_regular_file(error) || error) return false;
  const auto written = file.last_write_time(error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

}  // namespace

struct Cache::Impl {
  fs::path folder;
  std::uint64_t max_bytes;

  std::mutex mutex;                         ///< of what follows
  std::map<fs::path, FileDescriptor> used;  ///< each with its lock, if it has one
  std::vector<std::string> notes;
  std::set<std::string> said;

  void note(const std::string& text) {
    const std::lock_guard lock(mutex);
    if (said.insert(text).second) notes.push_back(text);
  }

  /// A shared lock, which the system gives back when the process ends, however it ends, keeps the
  /// entry from being pruned. Where the file system knows no locks, it does without.
  void hold(const fs::path& path, FileDescriptor file) {
    if (file && ::flock(file.get(), LOCK_SH) != 0) file = FileDescriptor();
    const std::lock_guard lock(mutex);
    const bool has_room = used.size() < max_locks;
    FileDescriptor& held = used[path];
    if (held || has_room) held = std::move(file);
  }

  bool is_used(const fs::path& path) {
    const std::lock_guard lock(mutex);
    return used.contains(path);
  }

  bool write(const fs::path& path, const std::string& key, std::span<const std::byte> payload) {
    try {
      write_atomically(path,
                       [&](const fs::path& temporary) { write_entry(temporary, key, payload); });
      return true;
    } catch (const FileError& error) {
      // Without the name of the entry: one note for all of them.
      note(
          fmt::format("cache {}: {}. Nothing is kept for the next time; check the folder, its "
                      "permissions and the free space, or name another one",
                      folder.string(), error.reason()));
      return false;
    }
  }

  /// The entries by name, size and time alone.
  std::vector<CacheEntry> entries() const {
    std::vector<CacheEntry> found;
    for (const fs::directory_entry& file : files()) {
      std::error_code error;
      if (!is_entry_name(file.path()) || !file.is_regular_file(error)) continue;
      CacheEntry entry;
      entry.path = file.path();
      entry.bytes = file.file_size(error);
      if (!error) entry.last_used = file.last_write_time(error);
      if (!error) found.push_back(std::move(entry));  // else it was just removed
    }
    std::sort(found.begin(), found.end(), [](const CacheEntry& a, const CacheEntry& b) {
      return a.last_used != b.last_used ? a.last_used > b.last_used : a.path < b.path;
    });
    return found;
  }

  std::vector<fs::directory_entry> files() const {
    std::vector<fs::directory_entry> found;
    std::error_code error;
    fs::directory_iterator file(folder, error);
    for (; !error && file != fs::directory_iterator(); file.increment(error)) {
      found.push_back(*file);
    }
    return found;
  }
};

Cache::Cache(fs::path folder, std::uint64_t max_bytes) : impl_(std::make_unique<Impl>()) {
  impl_->folder = whole_path(folder);
  impl_->max_bytes = max_bytes;
}

Cache::~Cache() = default;

const fs::path& Cache::folder() const { return impl_->folder; }

std::optional<std::vector<std::byte>> Cache::load(const std::string& key) {
  check_key(key);
  if (impl_->folder.empty()) return std::nullopt;
  const fs::path path = impl_->folder / name_of(key);
  FileDescriptor file = open_entry(path);
  if (!file) return std::nullopt;
  EntryContent content = read_entry(file, EntryPart::payload);
  if (content.fault.empty() && content.key != key) content.fault = "belongs to something else";
  if (!content.fault.empty()) {
    impl_->note(fmt::format("cache entry {}: {} and is rebuilt", path.string(), content.fault));
    return std::nullopt;
  }
  // In a folder that is read-only the time stays as it is.
  ::futimens(file.get(), nullptr);
  impl_->hold(path, std::move(file));
  return std::move(content.payload);
}

bool Cache::store(const std::string& key, std::span<const std::byte> payload) {
  check_key(key);
  if (impl_->folder.empty()) return false;
  if (payload.size() > impl_->max_bytes) {
    impl_->note(fmt::format("cache {}: {} MB are not kept, the limit is {} MB",
                            impl_->folder.string(), payload.size() / 1'000'000,
                            impl_->max_bytes / 1'000'000));
    return false;
  }
  const fs::path path = impl_->folder / name_of(key);
  if (!impl_->write(path, key, payload)) return false;
  impl_->hold(path, open_entry(path));
  prune();
  return true;
}

std::vector<CacheEntry> Cache::list(Check check) const {
  std::vector<CacheEntry> entries = impl_->entries();
  const EntryPart part = check == Check::header ? EntryPart::header : EntryPart::checked;
  for (CacheEntry& entry : entries) {
    const FileDescriptor file = open_entry(entry.path);
    if (!file) continue;
    EntryContent content = read_entry(file, part);
    entry.is_sound = content.fault.empty() && name_of(content.key) == entry.path.filename();
    entry.key = std::move(content.key);
  }
  return entries;
}

bool Cache::remove(const CacheEntry& entry) {
  if (!is_entry_name(entry.path) || entry.path.parent_path() != impl_->folder) return false;
  std::error_code error;
  fs::remove(entry.path, error);
  return !error;
}

std::uint64_t Cache::prune() {
  if (impl_->folder.empty()) return 0;
  std::uint64_t freed = 0;
  for (const fs::directory_entry& file : impl_->files()) {
    std::error_code error;
    if (!is_left_behind(file)) continue;
    const std::uint64_t size = file.file_size(error);
    if (!error && fs::remove(file.path(), error)) freed += size;
  }
  const std::vector<CacheEntry> entries = impl_->entries();
  std::uint64_t total = 0;
  for (const CacheEntry& entry : entries) total += entry.bytes;
  for (auto oldest = entries.rbegin(); oldest != entries.rend(); ++oldest) {
    if (total <= impl_->max_bytes) break;
    if (impl_->is_used(oldest->path) || is_locked(oldest->path) || !remove(*oldest)) continue;
    total -= oldest->bytes;
    freed += oldest->bytes;
  }
  return freed;
}

std::vector<std::string> Cache::take_notes() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->notes, {});
}

}  // namespace surf::io
