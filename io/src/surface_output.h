// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "mesh_output.h"
#include "surf/io/surface_file.h"

namespace surf::io {

/// The format by extension. Throws UsageError for an unknown one, Unsupported where it needs VTK.
const SurfaceFormat& surface_format_of(const std::filesystem::path& path);

/// All are whole under temporary names before the first is renamed; the last one is renamed last.
/// Throws UsageError where one of the others would replace a stranger (`refuse_strangers`). Returns
/// their names, the last one first.
std::vector<std::filesystem::path> write_all(std::span<const OutputFile> files);

/// Whether `write_view` is for it; glTF and 3MF have writers of their own.
bool has_view_writer(const SurfaceFormat& format);

/// Writes a valid scene, all files or none, and returns their names. Throws InvalidInput where its
/// numbers do not fit the format.
std::vector<std::filesystem::path> write_view(const std::filesystem::path& path, SceneView scene);

}  // namespace surf::io
