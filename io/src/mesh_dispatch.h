// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mesh_formats.h"

namespace surf::io {

enum class MeshFormat { stl, obj, ply, off, gltf, three_mf, vtp, vtm, unknown };

/// By content where that is telling, else by name.
MeshFormat mesh_format_of(const std::filesystem::path& path, std::string_view content);

/// Throws UsageError unless it is positive and finite.
void check_unit(double unit_nm, const std::string& file);

/// Reads a file of any format. `unit` as in `file_unit_nm`. Bodies without triangles are
/// left out, others have names (the file's, where it gives none) and are in nm. Throws FileError,
/// Unsupported, UsageError for a unit that is none.
ParsedFile parse_mesh_file(const std::filesystem::path& path, const MeshUnit& unit, Want want);

}  // namespace surf::io
