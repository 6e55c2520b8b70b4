// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/triangle_mesh.h"

namespace surf::workflow {

/// The box of what rises from the ground, or is sunk into it, within what is seen: walls are near
/// its sides, so that polynomials of it move them.
Box relief_box(const TriangleMesh& mesh, const Box& seen);

}  // namespace surf::workflow
