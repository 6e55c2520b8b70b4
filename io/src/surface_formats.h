// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "surf/io/surface_file.h"

namespace surf::io {

// One writer and one parser per format, behind write_surfaces and read_surfaces.

/// A file that a format is made of. The main one comes last and has the path asked for; the others
/// lie beside it, under names that begin with its stem.
struct OutputFile {
  std::filesystem::path path;
  std::string content;
};

// Writers: `scene` is valid; what the format cannot hold is left out.
std::vector<OutputFile> format_gltf(const std::filesystem::path& path, const SurfaceScene& scene,
                                    const Magnification& magnification);  // .glb and .gltf
std::vector<OutputFile> format_3mf(const std::filesystem::path& path, const SurfaceScene& scene,
                                   const Magnification& magnification);

// Readers: `file` is the name for messages, the result in nm, semsurf's magnification undone. A
// surface may have no triangles; the caller drops it.
SurfaceScene parse_gltf_scene(const std::filesystem::path& path, std::string_view content,
                              const MeshUnit& unit);
SurfaceScene parse_3mf_scene(const std::filesystem::path& path, std::string_view content,
                             const MeshUnit& unit);
bool is_3mf(std::string_view content);

}  // namespace surf::io
