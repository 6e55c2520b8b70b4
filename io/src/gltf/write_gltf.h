// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "mesh/scene_view.h"

namespace surf::io {

/// Formats a valid scene as .glb, or as .gltf with its buffer and pictures in files beside it.
std::vector<OutputFile> write_gltf(const std::filesystem::path& path, const SceneView& scene);

}  // namespace surf::io
