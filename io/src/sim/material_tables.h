// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/toml_table.h"
#include "surf/mc/physics/material.h"

namespace surf::io {

/// Reads a file named in a table.
using TextReader = std::function<std::string(const std::string& name)>;

/// Reads the [[material]] tables of a file, in order. Missing numbers are estimated with the help
/// of the materials in `known`. `read` reads files of energy-loss functions. Throws FileError,
/// UsageError or InvalidInput with line and key.
std::vector<mc::Material> read_material_tables(const TomlTable& root,
                                               std::span<const mc::Material> known,
                                               const TextReader& read);
/// A reader for files beside this one.
TextReader reader_beside(const std::filesystem::path& file);

}  // namespace surf::io
