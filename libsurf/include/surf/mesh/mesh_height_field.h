// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// The way back, from a height field to a mesh, is in height_field_mesh.h.

struct MeshHeightFieldOptions {
  double pitch_nm = 1;  ///< distance of samples along x and y, > 0

  /// Rectangle of the outermost samples' centres in x and y (z is ignored); its upper end is met as
  /// closely as whole pitches allow. Default: the mesh's own box.
  std::optional<Box> region_nm;

  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// The surface seen from above: at every sample the highest point of the mesh, as a ray along -z
/// meets it. Samples that no triangle covers are marked invalid (height 0). Edges belong to their
/// triangles; a sample within 1e-9 of a triangle's size outside of it counts as covered, so that
/// samples on the rim are. Undercuts are lost. Throws InvalidInput on damaged meshes or where no
/// sample is covered, UsageError for a bad pitch or region, Interrupted.
HeightField mesh_height_field(const TriangleMesh& mesh, const MeshHeightFieldOptions& options);

}  // namespace surf
