// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "bound_parameters.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/step_record.h"

namespace surf::cli {

/// --height-channel, --height-unit and --height-pitch, with their former names.
void add_height_reading(CLI::App& app, BoundParameters& bound, const std::string& group);

/// INPUT, --height-channel, --height-unit and --height-pitch. A `group` of "" hides them.
void add_scan_input(CLI::App& app, BoundParameters& bound, std::string& file,
                    const std::string& group = "Options");

/// Reads a scan and prints what had to be assumed, unless `quiet`. Throws UsageError, FileError.
io::HeightFieldFile read_scan(const std::string& file, const io::HeightReadOptions& options,
                              bool quiet);

/// -o, required; checked with io::check_height_field_target before any work.
void add_surface_output(CLI::App& app, std::optional<std::string>& output);

}  // namespace surf::cli
