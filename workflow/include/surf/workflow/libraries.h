// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "surf/io/cache.h"
#include "surf/mc/cascades/library_source.h"

namespace surf::workflow {

/// Libraries of cascades that are kept in a cache, page by page: what is there is loaded, what is
/// missing is made and stored, and all stays in memory for as long as this lives.
///
/// A page from the cache counts only if the cache finds it sound (io::Cache), it holds a page of
/// cascades, and its first cascades are word for word what this program makes (a few ms); else it
/// is made again and replaced. So the libraries are the same with any cache and without one.
class CachedLibraries : public mc::LibrarySource {
 public:
  /// `folder` as io::cache_folder gives it; empty: no cache. `max_bytes`: what io::Cache keeps to.
  explicit CachedLibraries(std::filesystem::path folder,
                           std::uint64_t max_bytes = io::Cache::default_max_bytes);
  ~CachedLibraries() override;
  CachedLibraries(const CachedLibraries&) = delete;
  CachedLibraries& operator=(const CachedLibraries&) = delete;

  /// Throws UsageError for settings that no library can have.
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t cascades, int threads,
                                                    const Watch& watch) override;

  /// Pages so far, for run records.
  struct Pages {
    std::size_t loaded = 0;  ///< from the cache
    std::size_t made = 0;
    std::size_t stored = 0;  ///< of those made
  };
  Pages pages() const;

  /// What went wrong since the last call, as sentences for the user; each is given once only.
  std::vector<std::string> take_notes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace surf::workflow
