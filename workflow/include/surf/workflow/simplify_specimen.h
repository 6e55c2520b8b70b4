// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/physics.h"

namespace surf::workflow {

/// How a body or a height field was simplified.
struct SimplifiedBody {
  std::string name;
  /// For a height field including the continuation that the scan needs.
  std::size_t triangles_before = 0;
  std::size_t triangles_after = 0;
  /// Bound of the distance between the two surfaces in nm, proven (see thin_height_field.h and
  /// distance_bound.h). 0 if the body is unchanged.
  double deviation_nm = 0;
  std::string kept;  ///< why it is unchanged; empty: it is simplified
};

struct Simplification {
  double tolerance_nm = 0;  ///< 0: no simplification was asked for
  /// The height field first, then the bodies in the specimen's order.
  std::vector<SimplifiedBody> bodies;
  double seconds = 0;
};

/// Returns the specimen with fewer triangles; no surface moves by more than `tolerance_nm` (> 0).
/// Meshes are simplified (simplify_mesh.h), except their vertices within 1e-3 nm of the substrate's
/// top or of another body, so that a common interface stays common. A height field is thinned
/// (thin_height_field.h) with its continuation for this beam and scan, and becomes the first body,
/// a sheet. A body is unchanged if nothing would be gained, if bodies stand on a height field, or
/// if its mesh would open, turn over or intersect itself even with a quarter of the tolerance.
///
/// The number of `threads` (0: one per hardware thread) does not change the result. Throws
/// UsageError if the tolerance is not above 0 and finite or a body is no thicker than it, throws
/// what mc::validate throws, and Interrupted.
mc::Specimen simplify_specimen(const mc::Specimen& specimen, double tolerance_nm,
                               const mc::Beam& beam, const mc::Scan& scan,
                               const mc::Physics& physics, int threads, Simplification& out,
                               const Watch& watch = {});

/// Warnings about a simplification: bodies that are unchanged, and a relief that vanishes.
std::vector<std::string> warnings_of(const mc::Specimen& specimen, const Simplification& done);

/// One line: "grain.ply: 99440 triangles to 6796, at most 0.72 nm off".
std::string describe(const SimplifiedBody& body);

}  // namespace surf::workflow
