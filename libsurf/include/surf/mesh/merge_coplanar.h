// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct MergeCoplanarOptions {
  /// Largest distance of triangles from their common plane, and of dropped corners from the edge
  /// that replaces them, >= 0.
  double tolerance_nm = 1e-10;
  Watch watch;
};

/// Represents the same surface with fewer triangles. Regions of coplanar triangles that share edges
/// are replaced by a constrained Delaunay triangulation. Vertices inside a region or on its
/// straight edges are dropped. If an outline has many corners that other regions need, new vertices
/// inside the region prevent slivers. No point of either surface is farther from the other surface
/// than the tolerance and rounding. Closed meshes stay closed; outlines, edges that do not have
/// exactly two triangles, and the orientation are kept. Corners count as one vertex only if their
/// indices are equal. Unchanged triangles keep their order. Takes O(n log n). Throws Interrupted.
TriangleMesh merge_coplanar(TriangleMesh mesh, const MergeCoplanarOptions& options = {});

}  // namespace surf
