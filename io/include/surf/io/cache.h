// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surf::io {

/// An entry of a cache as it lies on the disk.
struct CacheEntry {
  std::filesystem::path path;
  std::string key;                            ///< empty where it cannot be read
  std::uint64_t bytes = 0;                    ///< of the whole file
  std::filesystem::file_time_type last_used;  ///< when it was last stored or loaded
  bool is_sound = false;                      ///< whether `load` would take it; see `Cache::list`
};

/// A folder of files that spare work that was done before: a cache that is never trusted blindly.
///
/// A key is text that says everything the content depends on, the version of its own layout
/// included, best as lines "name = value". An entry is a file named by the key's SHA-256 that holds
/// the key in full, the payload and a checksum (XXH3, 128 bits) of both; it counts only if all of
/// these are right to the last bit. What is damaged, cut off, too long, foreign or of another
/// version of semsurf counts as absent, and the next `store` replaces it.
///
/// A cache never fails: where the folder is missing, read-only or full, loading finds nothing and
/// storing does nothing. The reasons are in `take_notes`, each once.
///
/// Threads and processes may share a folder and use, write and remove the same entry at once: files
/// appear whole and under their name in one step. The checksum finds accidents, not forgeries: do
/// not use a folder that people you do not trust can write to.
class Cache {
 public:
  static constexpr std::uint64_t default_max_bytes = std::uint64_t{4} << 30;
  static constexpr std::size_t max_key_bytes = std::size_t{1} << 20;

  /// `folder` is created by the first `store`; empty: nothing is ever found or stored.
  /// `max_bytes` is the size of all entries together that `store` keeps to.
  explicit Cache(std::filesystem::path folder, std::uint64_t max_bytes = default_max_bytes);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  const std::filesystem::path& folder() const;

  /// The payload last stored under this key, or nothing. Marks the entry as used now.
  /// Throws InvalidInput for a key that is empty or longer than `max_key_bytes`.
  std::optional<std::vector<std::byte>> load(const std::string& key);

  /// Stores a payload, replacing what was there, and removes the entries unused for longest until
  /// the limit is kept (`prune`). Returns whether it was stored. Throws as `load` does.
  bool store(const std::string& key, std::span<const std::byte> payload);

  /// Removes the entries unused for longest until all together are within `max_bytes`, and what
  /// writers that crashed more than a day ago left behind. Spares what is in use: the entries that
  /// this or any other living Cache, in this process or another on this machine, has loaded or
  /// stored (of each Cache the first 64). Returns the bytes freed.
  std::uint64_t prune();

  enum class Check { header, everything };
  /// The entries, the one used last first. `is_sound` says, after reading the first bytes of each
  /// (`header`), that length, version and key are right, or, after reading all of it
  /// (`everything`), that the checksum is too. Files that are not a cache's are left out. Marks
  /// nothing as used.
  std::vector<CacheEntry> list(Check check = Check::header) const;

  /// Removes an entry, in use or not (who has loaded it keeps what was loaded). Returns whether it
  /// is gone.
  bool remove(const CacheEntry& entry);

  /// What went wrong since the last call, as sentences for the user; each is given once only.
  std::vector<std::string> take_notes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Where semsurf keeps its cache: `option` if it is not empty, else $SEMSURF_CACHE, else
/// $XDG_CACHE_HOME/semsurf (if that is absolute, as its specification asks), else
/// $HOME/.cache/semsurf. Empty, which is no cache, if the first of these that is set is "off", or
/// if none is.
std::filesystem::path cache_folder(const std::string& option = {});

}  // namespace surf::io
