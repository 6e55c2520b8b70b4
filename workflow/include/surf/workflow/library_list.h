// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "surf/io/cache.h"
#include "surf/mc/cascades/cascade_key.h"

namespace surf::workflow {

/// A library of cascades as it lies in a cache.
struct StoredLibrary {
  mc::CascadePageName name;  ///< of its first page
  std::size_t cascades = 0;
  std::uint64_t bytes = 0;                    ///< of all its files
  std::filesystem::file_time_type last_used;  ///< of the page used last
  std::vector<io::CacheEntry> pages;          ///< in the order of their numbers
};

/// What a cache holds.
struct LibraryList {
  std::vector<StoredLibrary> libraries;  ///< by material, energy and seed
  std::vector<io::CacheEntry> damaged;   ///< whatever they were
};

/// `check` as io::Cache::list has it: `everything` reads all files.
LibraryList list_libraries(const io::Cache& cache, io::Cache::Check check);

}  // namespace surf::workflow
