// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "json_value.h"
#include "surf/core/vec3.h"

namespace surf::io {

/// x -> columns[0] x.x + columns[1] x.y + columns[2] x.z + columns[3].
struct AffineMap {
  std::array<Vec3, 4> columns{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{}};

  Vec3 operator()(const Vec3& p) const {
    return columns[0] * p.x + columns[1] * p.y + columns[2] * p.z + columns[3];
  }
  /// Whether it turns right-handed things into left-handed ones.
  bool mirrors() const { return dot(columns[0], cross(columns[1], columns[2])) < 0; }
};

/// A node of a glTF scene that shows a mesh.
struct GltfInstance {
  JsonValue node;
  JsonValue mesh;
  AffineMap to_scene;   ///< from the mesh's frame to the scene's, y up
};

/// Every showing of a mesh in the default scene (else in the first, else in the whole file), parents
/// before children. Throws FileError for a node with two parents or above itself, Unsupported for
/// meshes that a skeleton or shape keys deform.
std::vector<GltfInstance> gltf_instances(const JsonValue& root);

}  // namespace surf::io
