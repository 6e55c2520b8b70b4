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

/// A mesh file to be parsed.
struct MeshSource {
  std::filesystem::path path;  ///< name for messages; files that it names lie beside it
  std::string_view content;
  MeshUnit unit;
  Want want = Want::everything;

  std::string file() const { return path.string(); }
};

/// A mesh format. The parser's result is z up, with the file's own vertices (not merged), indices
/// in range, finite coordinates, in nm or in the unit stated by the note. It may have no triangles.
/// Failures are FileErrors, or Unsupported if something in the file cannot be read.
struct MeshFormat {
  /// For each extension of the format: the extension, and the data that it can hold.
  std::span<const SurfaceFormat> forms;
  /// Recognises the format by content alone; null if a format has no mark and is known by its name.
  bool (*is)(std::string_view content) = nullptr;
  ParsedFile (*parse)(const MeshSource& source) = nullptr;
  /// The files beside this one that must be opened to read its shapes; null if the format names
  /// none.
  std::vector<std::filesystem::path> (*named_files)(const std::filesystem::path& path,
                                                    std::string_view content) = nullptr;
  /// Makes the output files. The scene is valid; data that the format cannot hold are left out.
  std::vector<OutputFile> (*format)(const std::filesystem::path& path,
                                    const SceneView& scene) = nullptr;
  bool needs_vtk = false;  ///< VTK is needed for writing
  /// Numbers below this lose digits. 0: `format` checks its numbers itself.
  double least = 1e-290;
};

// surfaces/known_formats.cpp lists them.
extern const MeshFormat gltf_format, three_mf_format, obj_format, ply_format, off_format,
    vtp_format, vtm_format, stl_format;

/// The output of a format with a single file.
inline std::vector<OutputFile> one_file(const std::filesystem::path& path, std::string content) {
  std::vector<OutputFile> files;
  files.push_back({path, std::move(content)});
  return files;
}

}  // namespace surf::io
