// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "affine_map.h"
#include "json_value.h"

namespace surf::io {

/// A node of a glTF scene that shows a mesh.
struct GltfInstance {
  JsonValue node;
  JsonValue mesh;
  AffineMap to_scene;  ///< from the mesh's frame to the scene's, y up
};

/// Every showing of a mesh in the default scene (else in the first, else in the whole file),
/// parents before children. Throws FileError for a node with two parents or above itself,
/// Unsupported for meshes that a skeleton or shape keys deform.
std::vector<GltfInstance> gltf_instances(const JsonValue& root);

}  // namespace surf::io
