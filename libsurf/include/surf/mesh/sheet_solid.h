// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A closed body from an open sheet whose normals point up, as slicers and CAD want it: the sheet,
/// vertical walls under its rims and a flat base at `base_z_nm`, which must lie below every height.
/// The sheet's vertices and triangles come first and keep their places; triangles share the first
/// of equal vertices.
///
/// The base is a fan where the sheet has one rim that is star-shaped seen from above; else, with
/// holes or a ragged rim, it is the sheet itself laid flat, which must then nowhere overhang.
/// Throws InvalidInput on damaged meshes, closed ones, those not manifold or consistently oriented,
/// and overhangs (of the second kind); UsageError on a bad base, Interrupted.
TriangleMesh sheet_solid(const TriangleMesh& sheet, double base_z_nm, const Watch& watch = {});

}  // namespace surf
