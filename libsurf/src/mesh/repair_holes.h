// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/mesh/repair_mesh.h"

namespace surf {

/// Fills the holes of a merged mesh (every vertex is its own point) and returns their number. Adds
/// the number of new triangles to `fill_triangles`. Throws Interrupted.
std::size_t fill_holes(TriangleMesh& mesh, std::optional<double> max_hole_nm,
                       std::size_t& fill_triangles, const Watch& watch);

/// The holes of a merged mesh.
std::vector<OpenHole> open_holes(const TriangleMesh& mesh, std::optional<double> max_hole_nm);

}  // namespace surf
