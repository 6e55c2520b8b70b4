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

// Functions called by read_meshes, write_surfaces and write_tracks: VTK's polygonal data and its
// multi-block files. `file` is the name for messages.

bool is_vtp(std::string_view content);
/// Reads polygons and strips. If semsurf wrote the file, there is one body per number in the cells'
/// array "surface"; else one per text in the cells' or points' array "material", else one body.
/// Scalars are arrays of points with one component.
ParsedFile parse_vtp(const std::string& file, std::string_view content, Want want);
/// Reads the tracks of a file that `format_tracks` wrote.
std::vector<Track> parse_tracks(const std::string& file, std::string_view content);

bool is_vtm(std::string_view content);
/// Reads surfaces of all blocks, pictures and tracks from files in or below the folder of `path`.
/// Blocks of other kinds are refused.
ParsedFile parse_vtm(const std::filesystem::path& path, std::string_view content, Want want);
/// The files that a VTM file names.
std::vector<std::filesystem::path> vtm_part_files(const std::filesystem::path& path,
                                                  std::string_view content);

/// Field data with the surfaces' names.
inline constexpr const char* vtp_names_key = "surface:names";

/// The content of a VTP file: several surfaces as one data set, told apart by the cells' array
/// "surface". Throws Unsupported if the module `vtk` is missing, as `format_tracks` does.
std::string format_vtp(const std::string& file, const SceneView& scene);
std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata);
/// The main file, a block for each surface and picture, and one for all tracks.
std::vector<OutputFile> format_vtm(const std::filesystem::path& path, const SceneView& scene);

}  // namespace surf::io
