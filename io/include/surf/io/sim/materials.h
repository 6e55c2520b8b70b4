// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/mc/material.h"

namespace surf::io {

/// The materials that come with semsurf (data/materials.toml), in the order of the file.
const std::vector<mc::Material>& builtin_materials();

/// The material of that name (case matters: "Co" is not "CO"). Throws UsageError, naming `subject`
/// and listing the names, nearest first.
const mc::Material& find_material(const std::string& name, const std::string& subject);

}  // namespace surf::io
