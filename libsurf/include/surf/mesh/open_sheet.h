// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Makes an open sheet the top of a half-space: its rim is drawn out horizontally, each rim vertex
/// radially in x and y from the rim's centroid and at its own height, so far that the new rim is at
/// least `apron_nm` (> 0) outside the sheet's box.
///
/// The mesh must be manifold and consistently oriented, with exactly one boundary loop that seen
/// from above is star-shaped about its centroid (every ray from there meets it once). It may reach
/// sideways beyond that rim by 1 % of its size at most: else it is a body with a hole. Normals
/// point up where the rim runs counter-clockwise from above; a sheet that points down is turned.
/// Overhangs within the rim are allowed, and so are closed bodies beside the sheet, which stay as
/// they are.
///
/// The sheet's own vertices come first and keep their places; equal ones are merged. Returns
/// nothing if the mesh is no such sheet; `reason` then says why, in words that fit "it cannot stand
/// for the top of a half-space: {reason}". Throws InvalidInput on damaged meshes (`validate`),
/// UsageError on a bad apron.
std::optional<TriangleMesh> extend_open_sheet(const TriangleMesh& mesh, double apron_nm,
                                              std::string& reason);

}  // namespace surf
