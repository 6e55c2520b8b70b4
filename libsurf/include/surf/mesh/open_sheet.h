// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Extends an open sheet to the top of a half-space. The rim is extended horizontally: each rim
/// vertex moves radially in x and y away from the rim's centroid, at its own height, until the new
/// rim is at least `apron_nm` (> 0) outside the sheet's box.
///
/// The mesh must be manifold and consistently oriented, with exactly one boundary loop. Seen from
/// above, this loop must be star-shaped about its centroid: every ray from the centroid meets it
/// once. The mesh may extend sideways beyond the rim by at most 1 % of the rim's size; otherwise it
/// is a body with a hole. If the rim runs counter-clockwise seen from above, the normals point up;
/// a sheet whose normals point down is turned over. Overhangs within the rim are allowed. Closed
/// bodies beside the sheet are allowed and stay as they are.
///
/// The sheet's own vertices come first and keep their places; equal vertices are merged. Returns
/// nothing if the mesh is not such a sheet. `reason` then completes the sentence "it cannot stand
/// for the top of a half-space: {reason}". Throws InvalidInput on damaged meshes (`validate`),
/// UsageError on a bad apron.
std::optional<TriangleMesh> extend_open_sheet(const TriangleMesh& mesh, double apron_nm,
                                              std::string& reason);

}  // namespace surf
