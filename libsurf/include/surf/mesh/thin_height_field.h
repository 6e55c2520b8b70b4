// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct ThinOptions {
  double tolerance_nm = 0;  ///< >= 0
  /// Largest number of triangles, >= 2, whatever the tolerance; 0: no such limit.
  std::size_t triangles = 0;
  Watch watch;
};

struct ThinSummary {
  std::size_t triangles_before = 0;  ///< number of triangles of height_field_sheet
  std::size_t triangles_after = 0;
  /// Largest vertical distance between the two surfaces, nm. It is proven to rounding, not sampled.
  /// The distance in space is no larger.
  double deviation_nm = 0;
  bool reached = true;  ///< within the tolerance; false: the limit on triangles came first
};

struct ThinSheet {
  TriangleMesh mesh;
  ThinSummary summary;
};

/// An open sheet with fewer triangles over the same rectangle. It is nowhere farther than the
/// tolerance above or below `height_field_sheet`, or as near as the allowed number of triangles
/// permits. It has one height at every place, like the field, so it cannot intersect itself. Its
/// corners are samples of the field and include the field's four corners. The rim is thinned like
/// the rest, within the rectangle's sides. With a tolerance of 0 only exactly flat parts are
/// thinned.
///
/// Samples are added where the deviation is largest (greedy insertion, Garland and Heckbert 1995,
/// CMU-CS-95-181), to a Delaunay triangulation of sample positions in exact arithmetic. The
/// difference of two surfaces of triangles is largest at a sample or at a crossing of their edges
/// seen from above. Both are checked, and samples are added until all of them are within the
/// tolerance. A million samples take 1 to 30 s, longer if more triangles remain, and up to 0.2 GB.
/// Deterministic.
///
/// Throws InvalidInput on a damaged field or one with invalid samples, UsageError on bad options,
/// Interrupted.
ThinSheet thin_height_field(const HeightField& field, const ThinOptions& options);

}  // namespace surf
