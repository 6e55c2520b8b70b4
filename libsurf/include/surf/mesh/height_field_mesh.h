// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/edge.h"
#include "surf/core/height_field.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Throws InvalidInput for a damaged field or one with an invalid sample, Unsupported if there are
/// too many samples for 32-bit numbers.
void require_no_holes(const HeightField& field);

/// The open sheet of triangles over the samples, with normals up. Each cell is split from
/// lower-left to upper-right. Throws InvalidInput if a sample is invalid, because a hole has no
/// height.
TriangleMesh height_field_sheet(const HeightField& field);

/// The field enlarged by `margin_x_nm` and `margin_y_nm` (>= 0, rounded up to whole pitches) on
/// each side, and continued by `edge`.
HeightField extend_height_field(const HeightField& field, double margin_x_nm, double margin_y_nm,
                                Edge edge);

/// The sheet with its outermost heights extended horizontally by `apron_nm` (> 0) on every side, so
/// that the half-space below has a surface everywhere that electrons can reach.
TriangleMesh half_space_top(const HeightField& field, double apron_nm);

/// A closed body: the sheet, vertical walls and a flat base at `base_z_nm`, which must lie below
/// every height.
TriangleMesh height_field_solid(const HeightField& field, double base_z_nm);

}  // namespace surf
