// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A closed body from an open sheet whose normals point up, as slicers and CAD need it: the sheet,
/// vertical walls under its rims, and a flat base at `base_z_nm`, which must lie below every
/// height. The sheet's vertices and triangles come first and keep their places; triangles use the
/// first of several equal vertices.
///
/// If the sheet has a single rim that is star-shaped seen from above, the base is a fan. Otherwise
/// (with holes or a ragged rim) the base is the sheet itself projected to the base plane; the sheet
/// must then have no overhangs. Throws InvalidInput on damaged or closed meshes, meshes that are
/// not manifold or not consistently oriented, and overhangs in the second case; UsageError on a bad
/// base; Interrupted.
TriangleMesh sheet_solid(const TriangleMesh& sheet, double base_z_nm, const Watch& watch = {});

}  // namespace surf
