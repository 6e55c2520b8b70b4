// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/boundary.h"

namespace surf {

// The steps of repair_mesh on a merged mesh: every vertex is its own point. Each step returns the
// number of its repairs.

/// Merges rim vertices within `distance_nm` of each other.
std::size_t stitch_rims(TriangleMesh& mesh, double distance_nm);

/// Removes triangles with a repeated corner, without area, or flatter than `sliver_nm`.
std::size_t remove_degenerate(TriangleMesh& mesh, double sliver_nm);

/// Keeps one of several triangles on the same corners. If equally many of them have each
/// orientation, and the neighbours close without them, removes all of them.
std::size_t remove_duplicates(TriangleMesh& mesh);

/// Turns triangles so that neighbours agree. The larger part of each patch keeps its orientation.
std::size_t orient(TriangleMesh& mesh);

/// Turns closed components that enclose a negative volume, unless they lie inside another closed
/// component.
std::size_t turn_outward(TriangleMesh& mesh);

std::size_t drop_components(TriangleMesh& mesh, double min_diagonal_nm);

}  // namespace surf
