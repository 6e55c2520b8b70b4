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

/// Whether the name ends in a mesh format's extension (".stl", ".obj", ".ply", ".off").
bool is_mesh_file(const std::filesystem::path& path);

}  // namespace surf::io
