// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/request/simulation_request.h"

namespace surf::workflow {

/// Which libraries of cascades there are to be.
struct LibraryParameters {
  std::vector<double> energies_ev = {mc::Beam{}.energy_ev};  ///< of the beams, each once
  std::optional<std::int64_t> cascades;                      ///< in each, rounded up to whole pages
  std::optional<double> accuracy;    ///< of images that begin with so many; not with `cascades`
  mc::SimulationRequest simulation;  ///< its physics and seed
  std::filesystem::path cache;       ///< empty: none
  int threads = 0;                   ///< 0: one per hardware thread
};
void describe(ParameterVisitor& visit, LibraryParameters& parameters);

/// "500eV,1keV" in the order given, each once. Throws UsageError naming `subject`.
std::vector<double> parse_energies_ev(std::string_view text, const std::string& subject);

/// The number of cascades in each library, whole pages. Throws UsageError if both ways are used.
std::size_t cascades_of(const LibraryParameters& parameters);

/// Of one material, at each energy. Throws UsageError where no library can be of it.
std::vector<mc::CascadeSettings> libraries_of(const LibraryParameters& parameters,
                                              const mc::Material& material);

}  // namespace surf::workflow
