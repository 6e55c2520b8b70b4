// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "mesh/scene_view.h"

namespace surf::io {

/// A valid scene as .glb or, with its buffer and pictures beside it, .gltf.
std::vector<OutputFile> write_gltf(const std::filesystem::path& path, const SceneView& scene);

}  // namespace surf::io
