// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io_test.h"
#include "surf/io/cache.h"

namespace surf::test {

inline std::vector<std::byte> bytes_of(const std::string& text) {
  std::vector<std::byte> bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

/// What is stored under the key, as text.
inline std::optional<std::string> text_in(io::Cache& cache, const std::string& key) {
  const auto bytes = cache.load(key);
  if (!bytes) return std::nullopt;
  std::string text;
  for (const std::byte b : *bytes) text += static_cast<char>(b);
  return text;
}

/// The file of an entry.
inline std::filesystem::path path_of(const io::Cache& cache, const std::string& key) {
  for (const io::CacheEntry& entry : cache.list()) {
    if (entry.key == key) return entry.path;
  }
  return {};
}

/// Makes an entry look as if it was last used some hours ago.
inline void age(const std::filesystem::path& path, int hours) {
  std::filesystem::last_write_time(
      path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
}

}  // namespace surf::test
