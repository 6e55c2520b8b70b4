// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "parsed_file.h"
#include "scene_view.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/surface_file.h"

namespace surf::io {

/// A file of meshes to be parsed.
struct MeshSource {
  std::filesystem::path path;  ///< names it in messages; files that it names lie beside it
  std::string_view content;
  MeshUnit unit;
  Want want = Want::everything;

  std::string file() const { return path.string(); }
};

/// A format of meshes. The parser's result is z up, with the file's own vertices (not merged),
/// indices in range, finite coordinates, and units that the note states or in nm; it may have no
/// triangles. Failures are FileErrors; Unsupported where something in the file cannot be read.
struct MeshFormat {
  /// What it is called, and what it holds, under each of its extensions.
  std::span<const SurfaceFormat> forms;
  /// By content alone; null where a format has no mark and is known by its name.
  bool (*is)(std::string_view content) = nullptr;
  ParsedFile (*parse)(const MeshSource& source) = nullptr;
  /// The files beside it that reading its shapes opens; null where it names none.
  std::vector<std::filesystem::path> (*named_files)(const std::filesystem::path& path,
                                                    std::string_view content) = nullptr;
  /// The files that it is made of. The scene is valid; what the format cannot hold is left out.
  std::vector<OutputFile> (*format)(const std::filesystem::path& path,
                                    const SceneView& scene) = nullptr;
  bool needs_vtk = false;  ///< to be written
  /// Numbers below it lose digits. 0: `format` checks its numbers itself.
  double least = 1e-290;
};

// surfaces/known_formats.cpp lists them.
extern const MeshFormat gltf_format, three_mf_format, obj_format, ply_format, off_format,
    vtp_format, vtm_format, stl_format;

/// A format that is one file.
inline std::vector<OutputFile> one_file(const std::filesystem::path& path, std::string content) {
  std::vector<OutputFile> files;
  files.push_back({path, std::move(content)});
  return files;
}

}  // namespace surf::io
