// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "sim/toml_table.h"
#include "surf/mc/physics/material.h"

namespace surf::io {

/// The [[material]] tables of a file, in order; missing numbers are estimated with the help of the
/// materials in `known`. Throws FileError, UsageError or InvalidInput with line and key.
std::vector<mc::Material> read_material_tables(const TomlTable& root,
                                               std::span<const mc::Material> known);

}  // namespace surf::io
