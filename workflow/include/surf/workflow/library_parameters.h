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

/// The libraries of cascades to make.
struct LibraryParameters {
  std::vector<double> energies_ev = {mc::Beam{}.energy_ev};  ///< beam energies, each once
  std::optional<std::int64_t> cascades;  ///< cascades per library, rounded up to whole pages
  /// Accuracy of the images that the library is for; excludes `cascades`.
  std::optional<double> accuracy;
  mc::SimulationRequest simulation;  ///< physics and seed are taken from it
  std::filesystem::path cache;       ///< cache folder; empty: none
  int threads = 0;                   ///< 0: one per hardware thread
};
void describe(ParameterVisitor& visit, LibraryParameters& parameters);

/// Parses "500eV,1keV": the energies in the given order, each once. Throws UsageError naming
/// `subject`.
std::vector<double> parse_energies_ev(std::string_view text, const std::string& subject);

/// The number of cascades per library, in whole pages. Throws UsageError if both `cascades` and
/// `accuracy` are given.
std::size_t cascades_of(const LibraryParameters& parameters);

/// The settings of the libraries of one material, one per energy. Throws UsageError if the material
/// cannot have a library.
std::vector<mc::CascadeSettings> libraries_of(const LibraryParameters& parameters,
                                              const mc::Material& material);

}  // namespace surf::workflow
