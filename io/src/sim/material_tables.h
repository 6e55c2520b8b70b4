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

/// Reads the file that a table names.
using TextReader = std::function<std::string(const std::string& name)>;

/// The [[material]] tables of a file, in order; missing numbers are estimated with the help of the
/// materials in `known`. `read`: energy-loss functions. Throws FileError, UsageError or
/// InvalidInput with line and key.
std::vector<mc::Material> read_material_tables(const TomlTable& root,
                                               std::span<const mc::Material> known,
                                               const TextReader& read);
/// Of files beside this one.
TextReader reader_beside(const std::filesystem::path& file);

}  // namespace surf::io
