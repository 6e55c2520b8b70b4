// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/io/cache.h"
#include "surf/workflow/library_list.h"

namespace surf::workflow {

/// Which libraries of cascades are removed: those of all materials that are named, of all energies
/// that are named; of no names, none.
struct LibraryRemoval {
  std::vector<std::string> materials;
  std::vector<double> energies_ev;
  bool all = false;      ///< all libraries, and damaged files
  bool damaged = false;  ///< damaged files, besides
  bool dry_run = false;  ///< remove nothing
};

void describe(ParameterVisitor& visit, LibraryRemoval& removal);

/// What was removed, or would be.
struct RemovedLibraries {
  std::vector<StoredLibrary> libraries;
  std::size_t files = 0;  ///< of libraries, and damaged ones
  double bytes = 0;
};

/// Removes libraries from a cache. Throws UsageError where nothing is named, or a material of which
/// there is no library; FileError where files cannot be removed.
RemovedLibraries remove_libraries(io::Cache& cache, const LibraryRemoval& removal);

}  // namespace surf::workflow
