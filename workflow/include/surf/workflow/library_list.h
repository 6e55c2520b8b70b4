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

/// A library of cascades stored in a cache.
struct StoredLibrary {
  mc::CascadePageName name;  ///< name of its first page
  std::size_t cascades = 0;
  std::uint64_t bytes = 0;                    ///< size of all its files
  std::filesystem::file_time_type last_used;  ///< last use of any page
  std::vector<io::CacheEntry> pages;          ///< in order of page number
};

/// The libraries in a cache.
struct LibraryList {
  std::vector<StoredLibrary> libraries;  ///< ordered by material, energy and seed
  std::vector<io::CacheEntry> damaged;   ///< damaged entries, whatever they held
};

/// Lists the libraries of a cache. `check` as in io::Cache::list: `everything` reads all files.
LibraryList list_libraries(const io::Cache& cache, io::Cache::Check check);

}  // namespace surf::workflow
