// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "bound_parameters.h"

namespace surf::cli {

/// `semsurf noise counts`: how many electrons a beam that stands still gives.
struct CountsFiles {
  std::string scene;
  std::string csv;  ///< to write; empty: none
};
/// counts.scene and counts.csv.
void describe(ParameterVisitor& visit, CountsFiles& files);

/// All but the scene. A `group` of "" hides them.
void add_counts_options(CLI::App& app, BoundParameters& bound, const std::string& group);

int print_counts(const BoundParameters& bound, const std::optional<std::string>& plot, bool quiet);

}  // namespace surf::cli
