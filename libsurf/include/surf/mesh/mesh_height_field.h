// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// The inverse, from a height field to a mesh, is in height_field_mesh.h.

struct MeshHeightFieldOptions {
  double pitch_nm = 1;  ///< distance of samples along x and y, > 0

  /// Rectangle through the centres of the outermost samples in x and y (z is ignored). Its upper
  /// end is rounded to the nearest whole pitch. Default: the mesh's own box.
  std::optional<Box> region_nm;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// The surface seen from above: at every sample the highest point of the mesh, as a ray along -z
/// hits it. Samples without a triangle are marked invalid (height 0). Triangles include their
/// edges; a sample outside a triangle by at most 1e-9 of the triangle's size counts as covered, so
/// that samples on the rim do. Undercuts are lost. Throws InvalidInput on damaged meshes or if no
/// sample is covered, UsageError for a bad pitch or region, Interrupted.
HeightField mesh_height_field(const TriangleMesh& mesh, const MeshHeightFieldOptions& options);

}  // namespace surf
