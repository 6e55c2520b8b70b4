// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct MergeCoplanarOptions {
  double tolerance_nm = 1e-10;  ///< distance from a common plane, and of dropped corners from the
                                ///< edge that replaces theirs (>= 0)
  Watch watch;
};

/// The same surface with fewer triangles: those that share edges and lie in one plane are replaced
/// by a constrained Delaunay triangulation of the region that they cover, and vertices within that
/// region or on its straight edges are dropped. Where an outline has many corners that others need,
/// new vertices within the region keep triangles from becoming slivers. No point of either surface
/// is farther than the tolerance and rounding from the other. Closed meshes stay closed; outlines,
/// edges with other than two triangles, and orientation are kept. Corners count as one vertex where
/// their indices are equal. Triangles that do not change keep their order. Takes O(n log n). Throws
/// Interrupted.
TriangleMesh merge_coplanar(TriangleMesh mesh, const MergeCoplanarOptions& options = {});

}  // namespace surf
