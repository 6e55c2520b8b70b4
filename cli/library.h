// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "bound_parameters.h"
#include "commands.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/library_parameters.h"

namespace surf::cli {

/// The materials of libraries.
struct LibraryMaterials {
  std::vector<std::string> names;
  io::MaterialChoice own;  ///< its files
};
/// library.materials and specimen.materials.
void describe(ParameterVisitor& visit, LibraryMaterials& materials);

/// What is told of libraries.
struct LibraryOptions {
  BoundParameters bound;
  bool quiet = false;
};

/// Declares those that say which libraries there are to be.
void add_library_options(CLI::App& app, LibraryOptions& options);
void add_cache_option(CLI::App& app, BoundParameters& bound);

/// The same, read.
struct LibraryRequest {
  workflow::LibraryParameters parameters;
  std::vector<mc::CascadeSettings> libraries;  ///< material by material, each at all energies
  std::size_t cascades = 0;                    ///< in each, whole pages
};

/// Throws UsageError where something is missing, wrong or no library can be of it. What is good to
/// know is printed.
LibraryRequest read_library_options(const LibraryOptions& options);

// Each adds a subcommand of `semsurf library`.
void add_library_list(CLI::App& library, Action& action);
void add_library_build(CLI::App& library, Action& action);
void add_library_plot(CLI::App& library, Action& action);
void add_library_remove(CLI::App& library, Action& action);

}  // namespace surf::cli
