// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// The heights of a surface, seen from above, along a straight line: at `samples` (>= 2) places
/// from one end to the other. NaN where there is no triangle. Throws like `mesh_height_field`, and
/// UsageError for a line without length.
std::vector<double> height_profile(const TriangleMesh& mesh, Point2 from_nm, Point2 to_nm,
                                   int samples);

}  // namespace surf
