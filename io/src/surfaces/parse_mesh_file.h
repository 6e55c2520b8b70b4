// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "mesh/mesh_format.h"

namespace surf::io {

/// Reads a mesh file of any format. `unit` as in `file_unit_nm`. Bodies without triangles are left
/// out. The others are in nm and have names (made up if the file gives none). Throws FileError,
/// Unsupported, UsageError for an invalid unit.
ParsedFile parse_mesh_file(const std::filesystem::path& path, const MeshUnit& unit, Want want);

}  // namespace surf::io
