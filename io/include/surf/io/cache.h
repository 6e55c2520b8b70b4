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

/// A cache entry on the disk.
struct CacheEntry {
  std::filesystem::path path;
  std::string key;                            ///< empty if the key cannot be read
  std::uint64_t bytes = 0;                    ///< size of the whole file
  std::filesystem::file_time_type last_used;  ///< when it was last stored or loaded
  bool is_sound = false;                      ///< whether `load` would take it; see `Cache::list`
};

/// A folder of stored results that spares repeated work. Entries are always verified before use.
///
/// A key is text that names everything the content depends on, including the version of its layout,
/// best as lines "name = value". An entry is a file named by the key's SHA-256. It holds the key in
/// full, the payload, and a checksum (XXH3, 128 bits) of both. An entry counts only if all of these
/// are correct to the last bit. An entry that is damaged, cut off, too long, foreign or from
/// another version of semsurf counts as absent. The next `store` replaces it.
///
/// A cache never fails. If the folder is missing, read-only or full, loading finds nothing and
/// storing does nothing. `take_notes` gives each reason once.
///
/// Several threads and processes may share a folder and use, write and remove the same entry at
/// once: a file appears complete and under its name in one step. The checksum detects accidents,
/// not forgeries. Do not use a folder that people you do not trust can write to.
class Cache {
 public:
  static constexpr std::uint64_t default_max_bytes = std::uint64_t{4} << 30;
  static constexpr std::size_t max_key_bytes = std::size_t{1} << 20;

  /// The first `store` creates `folder`. With an empty path the cache finds and stores nothing.
  /// `store` keeps the total size of all entries within `max_bytes`.
  explicit Cache(std::filesystem::path folder, std::uint64_t max_bytes = default_max_bytes);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  const std::filesystem::path& folder() const;

  /// Returns the payload last stored under this key, or nothing. Marks the entry as used now.
  /// Throws InvalidInput if the key is empty or longer than `max_key_bytes`.
  std::optional<std::vector<std::byte>> load(const std::string& key);

  /// Stores a payload and replaces an earlier one. Then removes the least recently used entries
  /// until the limit is kept (`prune`). Returns whether the payload was stored. Throws as `load`
  /// does.
  bool store(const std::string& key, std::span<const std::byte> payload);

  /// Removes the least recently used entries until the total is within `max_bytes`, and the
  /// temporary files of writers that crashed more than a day ago. Spares entries in use: all that
  /// this Cache has loaded or stored, and the first 64 of every other living Cache, in this process
  /// or in another on this machine. Returns the number of bytes freed.
  std::uint64_t prune();

  enum class Check { header, everything };
  /// Lists the entries, the most recently used first. With `header`, `is_sound` says that length,
  /// version and key are correct, judged by the first bytes of the file. With `everything` the
  /// whole file is read, and `is_sound` says that the checksum is correct too. Files that are not
  /// cache entries are left out. Marks no entry as used.
  std::vector<CacheEntry> list(Check check = Check::header) const;

  /// Removes an entry, even one in use. A payload that was loaded before stays valid. Returns
  /// whether the entry is gone.
  bool remove(const CacheEntry& entry);

  /// Returns what went wrong since the last call, as sentences for the user. Each sentence is given
  /// only once.
  std::vector<std::string> take_notes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The folder of semsurf's cache: `option` if it is not empty, else $SEMSURF_CACHE, else
/// $XDG_CACHE_HOME/semsurf (if that path is absolute, as its specification demands), else
/// $HOME/.cache/semsurf. The result is empty, which means no cache, if the first of these that is
/// set is "off", or if none is set.
std::filesystem::path cache_folder(const std::string& option = {});

}  // namespace surf::io
