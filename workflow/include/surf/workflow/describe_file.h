// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/io/mesh_unit.h"

namespace surf::workflow {

enum class FileKind { scene, model, heights, sem_image, image, mesh, unknown };

/// What a file is, by its name and its first bytes. Unknown files may still be scans that Gwyddion
/// reads.
FileKind kind_of(const std::filesystem::path& path);

/// What is in a file as JSON, an object: `file`, `kind` ("scene", "model", "heights", "SEM image",
/// "image", "mesh"), then numbers with their units in their names, and what the file says of itself
/// as `metadata`. docs/reference/channels_and_metadata.md lists
/// the fields. Throws FileError, InvalidInput.
std::string describe_file(const std::filesystem::path& path, const io::MeshUnit& unit = {},
                          const std::vector<std::filesystem::path>& material_files = {});

}  // namespace surf::workflow
