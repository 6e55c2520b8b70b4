// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// Reads STL (text and binary), OBJ, PLY (text and binary) or OFF, by content and then by name.
/// Polygons are fanned into triangles; equal vertices are merged. `unit` is the length of one file
/// unit in nm (> 0): these formats carry none, so plain numbers are nm.
/// Throws FileError naming the file, the place and the remedy; never returns NaN vertices, indices
/// out of range or an empty mesh. Closedness is not checked here.
TriangleMesh read_mesh(const std::filesystem::path& path, double unit_nm = 1.0);

/// Writes by extension: STL (binary), OBJ, PLY (binary, little-endian, double) or OFF, one file
/// unit being `unit_nm` (> 0). Vertices and triangles keep their order. The file appears under its
/// name only when it is complete.
/// OBJ, PLY and OFF keep every digit: with a unit of 1 nm, reading gives the same doubles. STL has
/// 24 bits per coordinate (0.06 nm at 1 mm) and may so make vertices equal that were not.
/// Throws InvalidInput for a mesh that `validate` refuses or whose coordinates the format cannot
/// hold, UsageError for an unknown extension or unit, FileError.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, double unit_nm = 1.0);

/// Throws what `write_mesh` would for the name or folder, before any work is spent.
void check_mesh_target(const std::filesystem::path& path);

/// Whether the name ends in a mesh format's extension (".stl", ".obj", ".ply", ".off").
bool is_mesh_file(const std::filesystem::path& path);

}  // namespace surf::io
