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

/// Libraries of cascades that are stored in a cache, page by page. Pages in the cache are loaded,
/// missing pages are made and stored. All pages stay in memory while this object lives.
///
/// A page from the cache counts only if the cache finds it sound (io::Cache), if it holds a page of
/// cascades, and if its first cascades equal those that this program makes word for word (checked
/// in a few ms). Otherwise the page is made again and replaced. So the libraries are the same with
/// any cache and without one.
class CachedLibraries : public mc::LibrarySource {
 public:
  /// `folder` as from io::cache_folder; empty: no cache. `max_bytes`: the size limit of io::Cache.
  explicit CachedLibraries(std::filesystem::path folder,
                           std::uint64_t max_bytes = io::Cache::default_max_bytes);
  ~CachedLibraries() override;
  CachedLibraries(const CachedLibraries&) = delete;
  CachedLibraries& operator=(const CachedLibraries&) = delete;

  /// Throws UsageError for settings that no library can have.
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t cascades, int threads,
                                                    const Watch& watch) override;

  /// Numbers of pages so far, for run records.
  struct Pages {
    std::size_t loaded = 0;  ///< pages loaded from the cache
    std::size_t made = 0;
    std::size_t stored = 0;  ///< stored pages among those made
  };
  Pages pages() const;

  /// Returns what went wrong since the last call, as sentences for the user. Each sentence is given
  /// only once.
  std::vector<std::string> take_notes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace surf::workflow
