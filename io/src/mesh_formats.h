// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "surf/io/mesh_file.h"
#include "surf/mesh/surface.h"
#include "surface_note.h"

namespace surf::io {

/// A body in a file, in the file's units and under the file's name, which may be empty.
struct ParsedBody {
  std::string material;  ///< what the file calls it; empty where it says nothing
  Surface surface;  ///< scalars have names of the form that `validate` asks for, and finite values
};

/// All that a file holds, in its units; what it says of these is in the note.
struct ParsedFile {
  std::vector<ParsedBody> bodies;
  std::vector<Track> tracks;
  SurfaceNote note;
  bool unit_assumed = false;  ///< neither the file nor its reader said what a 1 is: 1 nm
};

/// What is wanted of a file: scalars, pictures and tracks take time and can be damaged.
enum class Want { shapes, everything };

// One parser per format, behind read_meshes and read_surfaces. `file` is the name for messages. The
// result is z up, with the file's own vertices (not merged), with indices in range; it may have no
// triangles. Coordinates are finite, but those of glTF may overflow in the scene's transforms.

ParsedFile parse_stl(const std::string& file, std::string_view content);
/// One mesh per material in use; of semsurf's own files one per object, with its picture.
ParsedFile parse_obj(const std::filesystem::path& path, std::string_view content, Want want);
ParsedFile parse_ply(const std::string& file, std::string_view content, Want want);
ParsedFile parse_off(const std::string& file, std::string_view content);
struct GltfMeshes {
  std::vector<NamedMesh> meshes;  ///< semsurf's exaggeration of heights undone
  double unit_nm;                 ///< of a metre, with semsurf's magnification undone
};
/// glTF 2.0 as text or GLB. One mesh per node and material. `path` is where buffers are looked for.
GltfMeshes parse_gltf(const std::filesystem::path& path, std::string_view content);
/// The files beside it in which its buffers lie.
std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path,
                                                     std::string_view content);

/// Whether the length is that which the count in a binary STL file demands.
bool is_binary_stl(std::string_view content);
/// "solid" and then, somewhere, "facet".
bool is_text_stl(std::string_view content);
bool is_ply(std::string_view content);
/// A first word that ends in "OFF".
bool is_off(std::string_view content);
bool is_glb(std::string_view content);

/// Splits a polygon into triangles around its first corner.
inline void add_fan(const std::vector<std::uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

/// Splits a strip: every other triangle runs the other way round. A corner given twice joins two
/// strips and makes no triangle.
inline void add_strip(const std::vector<std::uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::size_t odd = i % 2;
    const Triangle t{corners[i - 2], corners[i - 1 + odd], corners[i - odd]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
}

inline constexpr std::uint64_t max_mesh_vertices = std::uint64_t{1} << 32;

}  // namespace surf::io
