// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/mesh_format.h"
#include "surf/core/track.h"

namespace surf::io {

// Behind read_meshes, write_surfaces and write_tracks: VTK's polygonal data and its multi-block
// files. `file` is the name for messages.

bool is_vtp(std::string_view content);
/// One body per number in the cells' array "surface", where semsurf wrote the file, and per text in
/// the cells' or points' array "material", else one. Polygons and strips. Scalars are arrays of
/// points with one component.
ParsedFile parse_vtp(const std::string& file, std::string_view content, Want want);
/// The lines of a file that `format_tracks` wrote.
std::vector<Track> parse_tracks(const std::string& file, std::string_view content);

bool is_vtm(std::string_view content);
/// The surfaces of all blocks, pictures and tracks, from files in or below its folder. Blocks of
/// other kinds are refused.
ParsedFile parse_vtm(const std::filesystem::path& path, std::string_view content, Want want);
/// The files that it names.
std::vector<std::filesystem::path> vtm_part_files(const std::filesystem::path& path,
                                                  std::string_view content);

/// The field data that lists the surfaces' names.
inline constexpr const char* vtp_names_key = "surface:names";

/// Throws Unsupported where the module `vtk` is missing, as `format_tracks` does. The content of
/// the file: several surfaces as one data set, told apart by the cells' array "surface".
std::string format_vtp(const std::string& file, const SceneView& scene);
std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata);
/// The main file and a block for each surface, picture and all tracks.
std::vector<OutputFile> format_vtm(const std::filesystem::path& path, const SceneView& scene);

}  // namespace surf::io
