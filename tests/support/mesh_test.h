// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>

#include "surf/mesh/triangle_mesh.h"

namespace surf::test {

/// Adds the vertices and triangles of another mesh.
inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), more.vertices_nm.begin(), more.vertices_nm.end());
  for (const auto& [a, b, c] : more.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

/// Every triangle turned over.
inline TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Every triangle with its own three vertices, as in an STL file.
inline TriangleMesh exploded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices_nm.size());
    for (const std::uint32_t corner : t) soup.vertices_nm.push_back(mesh.vertices_nm[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Whether two meshes are the same to the last bit.
inline bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices_nm == b.vertices_nm && a.triangles == b.triangles;
}

}  // namespace surf::test
