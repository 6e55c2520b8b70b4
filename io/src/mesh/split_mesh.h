// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// One mesh per group: `group[t]` (below `groups`) says where triangle t belongs. Triangles keep
/// their order; each mesh has the vertices that its triangles use, in order of use. In
/// O(triangles).
std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups);

struct MeshPart {
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertices;  ///< the index that each vertex had
};

/// The same with the vertices in their old order. One that no triangle uses goes with the vertex
/// before it.
std::vector<MeshPart> split_in_order(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups);

/// All triangles of `addition` after those of `mesh`, over their own vertices.
void append(TriangleMesh& mesh, const TriangleMesh& addition);

}  // namespace surf::io
