// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct MeshDeviationOptions {
  /// Sample points are at most this far apart on both surfaces; > 0, or 0: 1.5 mean edges of the
  /// mesh with the shorter ones. Corners are always samples.
  double spacing_nm = 0;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Largest distances between two surfaces (Hausdorff), found at sample points.
struct MeshDeviation {
  double from_first_nm = 0;   ///< of any sample of the first surface from the second surface
  double from_second_nm = 0;  ///< the other way
  double spacing_nm = 0;      ///< of the samples: between them the distance can exceed these
                              ///< figures, but never by more than spacing / sqrt(3)

  double largest_nm() const { return std::max(from_first_nm, from_second_nm); }
};

/// Measures how far two surfaces are from each other. Throws InvalidInput on damaged meshes,
/// Interrupted.
MeshDeviation mesh_deviation(const TriangleMesh& first, const TriangleMesh& second,
                             const MeshDeviationOptions& options = {});

}  // namespace surf
