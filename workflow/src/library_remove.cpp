// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_remove.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "surf/core/error.h"
#include "surf/core/nearest.h"
#include "surf/workflow/library_parameters.h"

namespace surf::workflow {
namespace {

// Names that no library has are mistakes: the materials themselves may be long gone.
void check_names(const std::vector<std::string>& wanted, const LibraryList& list) {
  std::set<std::string> names;
  for (const StoredLibrary& l : list.libraries) names.insert(l.name.material);
  for (const std::string& name : wanted) {
    if (names.contains(name)) continue;
    const std::string guess = nearest(name, {names.begin(), names.end()});
    throw UsageError(name, "there is no library of it",
                     guess.empty() ? "List the libraries that there are"
                                   : fmt::format("Did you mean {}?", guess));
  }
}

bool is_wanted(const StoredLibrary& l, const LibraryRemoval& r) {
  if (r.all) return true;
  if (r.materials.empty() && r.energies_ev.empty()) return false;
  const auto same = [&](double e) { return std::abs(e - l.name.beam_energy_ev) < 1e-6 * e; };
  return (r.materials.empty() || std::ranges::count(r.materials, l.name.material) > 0) &&
         (r.energies_ev.empty() || std::ranges::any_of(r.energies_ev, same));
}

}  // namespace

void describe(ParameterVisitor& visit, LibraryRemoval& r) {
  visit(r.materials, {.name = "library.materials",
                      .help = "Materials whose libraries are removed",
                      .form = "MATERIAL"});
  visit.form(
      {.name = "library.energy",
       .help = "Beam energies whose libraries are removed",
       .form = "ENERGY,..."},
      [] { return std::string(); },
      [&](std::string_view text, const std::string& subject) {
        r.energies_ev = parse_energies_ev(text, subject);
      });
  visit(r.all, {.name = "library.all", .help = "Remove all libraries, and damaged files"});
  visit(r.damaged, {.name = "library.damaged", .help = "Remove damaged files"});
  visit(r.dry_run, {.name = "library.dry_run", .help = "Only list what would be removed"});
}

RemovedLibraries remove_libraries(io::Cache& cache, const LibraryRemoval& r) {
  const bool some = !r.materials.empty() || !r.energies_ev.empty();
  if (!some && !r.all && !r.damaged)
    throw UsageError("library remove", "what to remove is not given",
                     "Name materials or `library.energy`, or say `library.all` or "
                     "`library.damaged`");
  if (some && r.all)
    throw UsageError("`library.all`", "it is more than what is named", "Leave out one of the two");
  // What is asked for as damaged has to be looked at whole.
  const LibraryList list =
      list_libraries(cache, r.damaged ? io::Cache::Check::everything : io::Cache::Check::header);
  check_names(r.materials, list);
  RemovedLibraries removed;
  std::size_t stuck = 0;
  const auto drop = [&](const std::vector<io::CacheEntry>& entries) {
    for (const io::CacheEntry& entry : entries) {
      if (!r.dry_run && !cache.remove(entry)) {
        ++stuck;
        continue;
      }
      ++removed.files;
      removed.bytes += static_cast<double>(entry.bytes);
    }
  };
  for (const StoredLibrary& l : list.libraries) {
    if (!is_wanted(l, r)) continue;
    removed.libraries.push_back(l);
    drop(l.pages);
  }
  if (r.damaged || r.all) drop(list.damaged);
  if (stuck > 0)
    throw FileError(cache.folder().string(), fmt::format("{} files cannot be removed", stuck),
                    "Check the folder's permissions");
  return removed;
}

}  // namespace surf::workflow
