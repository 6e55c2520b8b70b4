// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "mesh/mesh_format.h"

namespace surf::io {

/// Reads a file of any format. `unit` as in `file_unit_nm`. Bodies without triangles are
/// left out, others have names (the file's, where it gives none) and are in nm. Throws FileError,
/// Unsupported, UsageError for a unit that is none.
ParsedFile parse_mesh_file(const std::filesystem::path& path, const MeshUnit& unit, Want want);

}  // namespace surf::io
