// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/mesh/repair_mesh.h"

namespace surf {

/// Fills holes of a merged mesh (every vertex is its own point); returns how many, and adds up the
/// triangles that took. Throws Interrupted.
std::size_t fill_holes(TriangleMesh& mesh, std::optional<double> max_hole_nm,
                       std::size_t& fill_triangles, const Watch& watch);

/// The holes that a merged mesh has.
std::vector<OpenHole> open_holes(const TriangleMesh& mesh, std::optional<double> max_hole_nm);

}  // namespace surf
