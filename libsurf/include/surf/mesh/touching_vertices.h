// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// For each vertex of `mesh`: 1 if it is within `distance_nm` (>= 0) of the surface of `other`,
/// else 0. Throws InvalidInput on damaged meshes, UsageError on a bad distance.
std::vector<std::uint8_t> touching_vertices(const TriangleMesh& mesh, const TriangleMesh& other,
                                            double distance_nm);

}  // namespace surf
