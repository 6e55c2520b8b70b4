// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mc/cascades/cascade_library.h"

namespace surf::workflow {

/// A library that is in the cache now.
struct BuiltLibrary {
  std::size_t cascades = 0, made = 0;  ///< in all, and those of them that were made now
  std::uint64_t bytes = 0;
  std::vector<std::string> warnings;  ///< what was wrong with the cache
};

/// Makes what is missing of one library and keeps it in the cache. Its cascades leave the memory
/// when it is done. Throws UsageError if the cache could never hold it, FileError if it cannot be
/// kept, Interrupted. `title` is for messages.
BuiltLibrary build_library(const mc::CascadeSettings& settings, const std::string& title,
                           std::size_t cascades, const std::filesystem::path& cache, int threads,
                           const Watch& watch);

/// "Si at 1 keV".
std::string library_title(const std::string& material, double beam_energy_ev);

}  // namespace surf::workflow
