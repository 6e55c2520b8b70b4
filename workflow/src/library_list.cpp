// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_list.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace surf::workflow {

LibraryList list_libraries(const io::Cache& cache, io::Cache::Check check) {
  LibraryList list;
  std::map<std::string, std::map<std::size_t, io::CacheEntry>> pages;  // by library and number
  std::map<std::string, StoredLibrary> libraries;
  for (io::CacheEntry& entry : cache.list(check)) {
    if (!entry.is_sound) {
      list.damaged.push_back(std::move(entry));
      continue;
    }
    const auto name = mc::read_cascade_page_key(entry.key);
    if (!name) continue;
    StoredLibrary& library = libraries[name->library];
    auto& numbered = pages[name->library];
    if (numbered.empty() || name->number < numbered.begin()->first) library.name = *name;
    library.cascades += name->cascades;
    library.bytes += entry.bytes;
    library.last_used = std::max(library.last_used, entry.last_used);
    numbered[name->number] = std::move(entry);
  }
  for (auto& [key, library] : libraries) {
    for (auto& [number, entry] : pages[key]) library.pages.push_back(std::move(entry));
    list.libraries.push_back(std::move(library));
  }
  const auto order = [](const StoredLibrary& l) {
    return std::tie(l.name.material, l.name.beam_energy_ev, l.name.seed, l.name.library);
  };
  std::sort(list.libraries.begin(), list.libraries.end(),
            [&](const StoredLibrary& a, const StoredLibrary& b) { return order(a) < order(b); });
  return list;
}

}  // namespace surf::workflow
