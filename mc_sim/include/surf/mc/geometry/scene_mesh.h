// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/mesh_view.h"

namespace surf::mc {

/// Values that do not change, in memory of this process or in memory that several share.
template <class T>
struct SharedArray {
  std::span<const T> values;
  std::shared_ptr<const void> owner;  ///< keeps them

  SharedArray() = default;
  SharedArray(std::span<const T> of_owner, std::shared_ptr<const void> held)
      : values(of_owner), owner(std::move(held)) {}
  explicit SharedArray(std::vector<T> own) {
    const auto held = std::make_shared<std::vector<T>>(std::move(own));
    values = *held;
    owner = held;
  }
};

/// All triangles of a scene.
struct SceneMesh {
  SharedArray<Vec3> vertices_nm;
  SharedArray<Triangle> triangles;      ///< indices into vertices_nm
  SharedArray<std::uint32_t> shell_of;  ///< per triangle; empty where nobody asks for it
  /// For the ray tracer: x, y, z of each vertex about `center_nm`, and 16 bytes that may be read.
  SharedArray<float> local_nm;
  Vec3 center_nm;  ///< of the box around all vertices

  MeshView view() const { return {vertices_nm.values, triangles.values}; }
  bool empty() const { return triangles.values.empty(); }
};

SceneMesh make_scene_mesh(TriangleMesh mesh, std::vector<std::uint32_t> shell_of);

}  // namespace surf::mc
