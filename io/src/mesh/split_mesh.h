// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

/// Makes one mesh per group: `group[t]` (below `groups`) is the group of triangle t. Triangles keep
/// their order. Each mesh has the vertices that its triangles use, in order of use. Takes
/// O(triangles).
std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups);

struct MeshPart {
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertices;  ///< index of each vertex in the original mesh
};

/// Like `split_mesh`, with the vertices in their old order. A vertex that no triangle uses goes
/// with the vertex before it.
std::vector<MeshPart> split_in_order(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups);

/// Appends all triangles of `addition`, with their own vertices.
void append(TriangleMesh& mesh, const TriangleMesh& addition);

}  // namespace surf::io
