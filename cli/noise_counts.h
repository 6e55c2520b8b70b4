// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace surf::cli {

/// `semsurf noise counts`: how many electrons a beam that stands still gives.
struct CountsInput {
  std::optional<std::string> scene, at, electrons, trials, seed, threads, csv;
};

/// All but the scene. A `group` of "" hides them.
void add_counts_options(CLI::App& app, CountsInput& input, const std::string& group);

/// Throws UsageError if one of them is given without a scene.
void require_counts(const CountsInput& input);

int print_counts(const CountsInput& input, const std::optional<std::string>& plot, bool quiet);

}  // namespace surf::cli
