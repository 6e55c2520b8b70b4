// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"

namespace surf {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices. Seen from outside the body, the corners of a triangle run
/// counter-clockwise: its normal points out. Closedness is not assumed; `check_mesh` reports it.
struct TriangleMesh {
  std::vector<Vec3> vertices_nm;
  std::vector<Triangle> triangles;  ///< indices into vertices_nm
};

/// The box around all vertices; empty for a mesh without vertices.
Box bounds(const TriangleMesh& mesh);

/// Multiplies every coordinate by `factor` (> 0) and then adds `offset_nm`.
void transform(TriangleMesh& mesh, double factor, const Vec3& offset_nm);

/// Merges vertices with exactly the same coordinates, as in STL files, where each triangle has
/// three vertices of its own. Keeps the order of first appearance; unused vertices are dropped.
TriangleMesh merge_equal_vertices(const TriangleMesh& mesh);

/// Throws InvalidInput (naming `subject`) if there is no triangle, an index is out of range, or a
/// vertex is NaN or infinite; the message names the first fault. Throws Unsupported if there are
/// more than 1.4 billion triangles.
void validate(const TriangleMesh& mesh, const char* subject = "mesh");

}  // namespace surf
