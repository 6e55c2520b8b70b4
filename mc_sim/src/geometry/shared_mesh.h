// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mc/geometry/shared_memory.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::mc {

/// Triangles that somebody else holds, as a `TriangleMesh` has them.
struct MeshView {
  std::span<const Vec3> vertices_nm;
  std::span<const Triangle> triangles;

  MeshView() = default;
  MeshView(const TriangleMesh& mesh) : vertices_nm(mesh.vertices_nm), triangles(mesh.triangles) {}
};

inline Box bounds(const MeshView& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices_nm) box.extend(v);
  return box;
}

/// All triangles of a scene, wherever they lie: in this process, or in memory shared with others.
struct SceneMesh {
  MeshView mesh;
  std::span<const std::uint32_t> shell_of;   ///< per triangle
  /// For the ray tracer: x, y, z of each vertex about `center`, and 16 bytes that may be read.
  std::span<const float> local;
  Vec3 center;
  std::shared_ptr<const void> owner;         ///< keeps all of it
};

/// `shell_of` may be empty where nobody asks for it.
SceneMesh make_scene_mesh(TriangleMesh mesh, std::vector<std::uint32_t> shell_of);

/// The same in memory that the processes of a machine share: called by all, what is given is asked of
/// the first alone.
SceneMesh share_scene_mesh(NodeMemory& node, TriangleMesh mesh, std::vector<std::uint32_t> shell_of);

}  // namespace surf::mc
