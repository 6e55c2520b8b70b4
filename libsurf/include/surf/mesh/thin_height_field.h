// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct ThinOptions {
  double tolerance_nm = 0;    ///< >= 0
  std::size_t triangles = 0;  ///< at most so many, >= 2, whatever the tolerance; 0: no such limit
  Watch watch;
};

struct ThinSummary {
  std::size_t triangles_before = 0;  ///< of height_field_sheet
  std::size_t triangles_after = 0;
  /// Largest vertical distance of the two surfaces, nm: proven, not sampled (to rounding). Their
  /// distance in space is no larger.
  double deviation_nm = 0;
  bool reached = true;  ///< within the tolerance; else the limit came first
};

struct ThinSheet {
  TriangleMesh mesh;
  ThinSummary summary;
};

/// An open sheet of fewer triangles over the same rectangle, nowhere farther than the tolerance
/// above or below `height_field_sheet`, or as near as it comes to that with the triangles allowed.
/// It has one height over every place as the field has, so that it cannot pass through itself; its
/// corners are samples of the field, the field's four corners among them. The rim is thinned like
/// the rest, within the rectangle's sides. A tolerance of 0 leaves out what is exactly flat.
///
/// Samples are added where the surface is farthest off (greedy insertion, Garland and Heckbert
/// 1995, CMU-CS-95-181) to a Delaunay triangulation of sample positions in exact arithmetic. The
/// difference of two surfaces of triangles is largest at a sample or where their edges cross seen
/// from above: both are looked at, and samples added until all of them fit. A million samples take
/// 1 to 30 s, the more the more triangles stay, and up to 0.2 GB. Deterministic.
///
/// Throws InvalidInput on a damaged field or one with invalid samples, UsageError on bad options,
/// Interrupted.
ThinSheet thin_height_field(const HeightField& field, const ThinOptions& options);

}  // namespace surf
