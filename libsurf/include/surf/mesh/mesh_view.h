// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A non-owning view of a triangle mesh, laid out as in `TriangleMesh`.
struct MeshView {
  std::span<const Vec3> vertices_nm;
  std::span<const Triangle> triangles;

  MeshView() = default;
  MeshView(std::span<const Vec3> vertices, std::span<const Triangle> corners)
      : vertices_nm(vertices), triangles(corners) {}
  MeshView(const TriangleMesh& mesh) : vertices_nm(mesh.vertices_nm), triangles(mesh.triangles) {}
};

inline Box bounds(const MeshView& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices_nm) box.extend(v);
  return box;
}

}  // namespace surf
