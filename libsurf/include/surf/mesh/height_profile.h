// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Heights of a surface seen from above along a straight line: `samples` (>= 2) places from one end
/// to the other; NaN where no triangle lies. Throws what `mesh_height_field` throws, and UsageError
/// for a line without length.
std::vector<double> height_profile(const TriangleMesh& mesh, Point2 from_nm, Point2 to_nm,
                                   int samples);

}  // namespace surf
