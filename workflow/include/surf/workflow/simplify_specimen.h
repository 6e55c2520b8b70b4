// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/physics.h"

namespace surf::workflow {

/// What became of a body or a height field.
struct SimplifiedBody {
  std::string name;
  std::size_t triangles_before =
      0;  ///< of a height field: with the continuation that the scan needs
  std::size_t triangles_after = 0;
  /// Largest distance of the two surfaces, measured afterwards, nm: of a height field proven, of a
  /// mesh at samples (see mesh_deviation.h). 0 if it stays as it is.
  double deviation_nm = 0;
  std::string kept;  ///< why it stays as it is; empty: it is simplified
};

struct Simplification {
  double tolerance_nm = 0;             ///< 0: nothing was asked for
  std::vector<SimplifiedBody> bodies;  ///< the height field first, then in the specimen's order
  double seconds = 0;
};

/// The specimen with fewer triangles, no surface moved by more than `tolerance_nm` (> 0). Meshes
/// are simplified (simplify_mesh.h), but for their vertices within 1e-3 nm of the substrate's top
/// or of another body: what is one interface stays one. A height field is thinned
/// (thin_height_field.h) with its continuation for this beam and scan, and becomes the first body,
/// a sheet. A body stays as it is where nothing would be gained, where bodies stand on a height
/// field, or where its mesh, tried with a quarter of the tolerance at last, would open, turn over
/// or pass through itself.
///
/// `threads` (0: one per hardware thread) do not change the result. Throws UsageError if the
/// tolerance is not above 0 and finite or a body is no thicker than it, and as mc::validate does,
/// Interrupted.
mc::Specimen simplify_specimen(const mc::Specimen& specimen, double tolerance_nm,
                               const mc::Beam& beam, const mc::Scan& scan,
                               const mc::Physics& physics, int threads, Simplification& out,
                               const Watch& watch = {});

/// What the user should know of it: bodies that stay as they are, and a relief that vanishes.
std::vector<std::string> warnings_of(const mc::Specimen& specimen, const Simplification& done);

/// One line for people: "grain.ply: 99440 triangles to 6796, at most 0.72 nm off".
std::string describe(const SimplifiedBody& body);

}  // namespace surf::workflow
