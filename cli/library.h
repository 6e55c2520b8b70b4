// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "surf/mc/cascade_library.h"

namespace surf::cli {

/// Which libraries are meant, as text; absent: not given.
struct LibraryOptions {
  std::vector<std::string> materials;        ///< names
  std::vector<std::string> material_files;   ///< of the user's own
  std::optional<std::string> energy, physics, cutoff, seed, cascades, accuracy, cache, threads;
  bool quiet = false;
};

/// Declares those that say which libraries there are to be.
void add_library_options(CLI::App& app, LibraryOptions& options);
void add_cache_option(CLI::App& app, LibraryOptions& options);

/// The same, read.
struct LibraryRequest {
  std::vector<mc::CascadeSettings> libraries;   ///< material by material, each at all energies
  std::vector<double> energies_ev;              ///< of the beams
  std::size_t cascades = 0;                     ///< in each, whole pages
  int threads = 0;
  std::filesystem::path cache;                  ///< empty: none
};

/// Throws UsageError where something is missing, wrong or no library can be of it. What is good to
/// know is printed.
LibraryRequest read_library_options(const LibraryOptions& options);

/// "500eV,1keV" to numbers in the order given, each once.
std::vector<double> parse_energies_ev(const std::string& text);

/// "Si at 1 keV".
std::string library_title(const std::string& material, double beam_energy_ev);

// Each adds a subcommand of `semsurf library`.
void add_library_list(CLI::App& library, Action& action);
void add_library_build(CLI::App& library, Action& action);
void add_library_plot(CLI::App& library, Action& action);
void add_library_remove(CLI::App& library, Action& action);

}  // namespace surf::cli
