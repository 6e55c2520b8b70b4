// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "bound_parameters.h"

namespace surf::cli {

// Options that mean the same for several commands, as text; the caller may put each into a group.

CLI::Option* add_quiet_flag(CLI::App& app, bool& quiet);

/// --threads, and what it says: 0 (one per hardware thread) where it is absent. Throws UsageError.
void add_threads_option(CLI::App& app, BoundParameters& bound, const std::string& group);
int threads_of(const BoundParameters& bound);

}  // namespace surf::cli
