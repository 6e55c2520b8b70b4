// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/io/height_field_file.h"

namespace surf::cli {

/// The scan that the AFM commands read, as text.
struct ScanInput {
  std::string file;
  std::optional<std::string> channel, z_unit, pixel_size;
};

/// INPUT, --channel, --z-unit and --pixel-size (the last two for files that do not say).
void add_scan_input(CLI::App& app, ScanInput& input);

/// Reads it and prints what had to be assumed, unless `quiet`. Throws UsageError, FileError.
io::HeightFieldFile read_scan(const ScanInput& input, bool quiet);

/// -o, required; checked with io::check_height_field_target before any work.
void add_surface_output(CLI::App& app, std::optional<std::string>& output);

/// What an output says of how it was made: version, the command's name, its options that change the
/// result, the inputs with their hashes.
std::map<std::string, std::string> provenance_of(const std::string& command,
                                                 const std::map<std::string, std::string>& options,
                                                 const std::vector<std::string>& inputs);

}  // namespace surf::cli
