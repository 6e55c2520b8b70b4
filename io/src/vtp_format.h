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

// Behind read_meshes, write_mesh and write_tracks: VTK's polygonal data. `file` is the name for
// messages.

bool is_vtp(std::string_view content);
/// One mesh per text in the cells' or points' array "material", else one. Polygons and strips.
std::vector<NamedMesh> parse_vtp(const std::string& file, std::string_view content);

/// Whether this build has VTK, which writes the format. Else what follows throws Unsupported.
bool has_vtp_writer();
/// The content of the file.
std::string format_vtp(const std::string& file, const TriangleMesh& mesh);
std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata);

}  // namespace surf::io
