// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/libraries.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "library_page.h"
#include "surf/core/error.h"

namespace surf::workflow {

struct CachedLibraries::Impl {
  Impl(std::filesystem::path folder, std::uint64_t max_bytes)
      : cache(std::move(folder), max_bytes) {}

  io::Cache cache;
  std::map<std::string, mc::CascadeLibrary> kept;  ///< by key of the first page
  Pages pages;
  std::vector<std::string> notes;
  std::set<std::string> said;

  void note(const std::string& text) {
    if (said.insert(text).second) notes.push_back(text);
  }

  bool refuse(const mc::CascadeLibrary& library, const char* reason) {
    const mc::CascadeSettings& s = library.settings();
    note(fmt::format("cascades of {} at {:g} eV in the cache {}: {} and are made again",
                     s.material.name, s.start_energy_ev - library.medium().barrier_ev(),
                     cache.folder().string(), reason));
    return false;
  }

  /// Adds the next page from the cache; false if there is no valid page.
  bool load(mc::CascadeLibrary& library) {
    const std::size_t number = library.pages();
    const auto bytes = cache.load(mc::cascade_page_key(library.settings(), number));
    if (!bytes) return false;
    auto page = page_from_bytes(*bytes);
    if (!page) return refuse(library, "they are cut off");
    if (!library.would_make(*page, number))
      return refuse(library, "they are of another version of semsurf or kind of processor");
    try {
      library.add_page(std::make_shared<const mc::CascadePage>(std::move(*page)));
    } catch (const InvalidInput&) {
      return refuse(library, "they are not cascades");
    }
    ++pages.loaded;
    return true;
  }

  /// Adds the next page and stores it.
  void make(mc::CascadeLibrary& library, int threads, const Watch& watch) {
    const std::size_t number = library.pages();
    auto page = std::make_shared<const mc::CascadePage>(library.make_page(number, threads, watch));
    if (cache.store(mc::cascade_page_key(library.settings(), number), page_to_bytes(*page)))
      ++pages.stored;
    library.add_page(std::move(page));
    ++pages.made;
  }
};

CachedLibraries::CachedLibraries(std::filesystem::path folder, std::uint64_t max_bytes)
    : impl_(std::make_unique<Impl>(std::move(folder), max_bytes)) {}

CachedLibraries::~CachedLibraries() = default;

std::shared_ptr<const mc::CascadeLibrary> CachedLibraries::library(
    const mc::CascadeSettings& settings, std::size_t cascades, int threads, const Watch& watch) {
  constexpr std::size_t page_size = mc::CascadeLibrary::page_cascades;
  mc::CascadeLibrary& library =
      impl_->kept.try_emplace(mc::cascade_page_key(settings, 0), settings).first->second;
  const auto report = [&](double done) {
    const auto total = static_cast<double>(cascades);
    if (watch.progress) watch.progress(std::min(done, total), total);
  };
  while (library.cascades() < cascades) {
    watch.check();
    const auto before = static_cast<double>(library.cascades());
    if (impl_->load(library)) report(static_cast<double>(library.cascades()));
    else
      impl_->make(library, threads,
                  {[&](double of_page, double) { report(before + of_page); }, watch.cancel});
  }
  return std::make_shared<const mc::CascadeLibrary>(
      library.first((cascades + page_size - 1) / page_size));
}

CachedLibraries::Pages CachedLibraries::pages() const { return impl_->pages; }

std::vector<std::string> CachedLibraries::take_notes() {
  for (const std::string& text : impl_->cache.take_notes()) impl_->note(text);
  return std::exchange(impl_->notes, {});
}

}  // namespace surf::workflow
