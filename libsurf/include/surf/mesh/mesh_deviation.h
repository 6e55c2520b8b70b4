// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct MeshDeviationOptions {
  /// Largest distance between neighbouring sample points on both surfaces; > 0, or 0: 1.5 mean
  /// edges of the mesh with the shorter mean edge. Corners are always samples.
  double spacing_nm = 0;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Largest distances between two surfaces (Hausdorff), measured at sample points.
struct MeshDeviation {
  double from_first_nm = 0;   ///< largest distance of a sample of the first surface from the second
  double from_second_nm = 0;  ///< largest distance of a sample of the second surface from the first
  /// Spacing of the samples. Between samples the distance can exceed these numbers, but never by
  /// more than spacing / sqrt(3).
  double spacing_nm = 0;

  double largest_nm() const { return std::max(from_first_nm, from_second_nm); }
};

/// Measures the distance between two surfaces. Throws InvalidInput on damaged meshes, Interrupted.
MeshDeviation mesh_deviation(const TriangleMesh& first, const TriangleMesh& second,
                             const MeshDeviationOptions& options = {});

}  // namespace surf
