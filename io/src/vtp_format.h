// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/track.h"
#include "surf/io/mesh_file.h"

namespace surf::io {

// Behind read_meshes, write_mesh and write_tracks: VTK's polygonal data. The functions that format
// give the content of the file; `file` is the name for messages. Where this build lacks VTK all but
// the first two throw Unsupported.

bool is_vtp(std::string_view content);
bool has_vtp();

/// One mesh per text in the cells' or points' array "material", else one. Polygons and strips.
std::vector<NamedMesh> parse_vtp(const std::string& file, std::string_view content);
std::string format_vtp(const std::string& file, const TriangleMesh& mesh);
std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata);

}  // namespace surf::io
