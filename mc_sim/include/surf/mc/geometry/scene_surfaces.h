// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/scene_mesh.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// A closed connected surface, or the substrate's plane.
struct Shell {
  int solid = 0;  ///< which solid it bounds
  int sense = 1;  ///< 1: normals point out of what it encloses; -1: a cavity
};

/// A body, height field or substrate. Later ones win where they overlap.
struct Solid {
  int material = 0;
};

/// The surfaces of a specimen as a `Scene` traces them: whoever has them needs no bodies any more.
struct SceneSurfaces {
  SceneMesh mesh;  ///< empty for a bare substrate; a height field goes on beyond its samples
  std::vector<Shell> shells;
  std::vector<Solid> solids;
  std::optional<double> plane_nm;  ///< top of the substrate, which is shell 0
  Box box;                         ///< the surface without what was added beyond samples and sheets
  std::size_t triangles_left_out = 0;  ///< besides those in `mesh`: out of every electron's reach
  bool half_space = false;             ///< whether something goes on below without end
  double build_seconds = 0;
};

struct SurfaceOptions {
  /// Whether to leave out triangles that neither the beam nor any electron can reach: those farther
  /// from all vacuum open to the outside than the ranges at beam energy in all materials together.
  /// It changes no detector's mean or variance.
  bool leave_out_unreachable = true;
  Watch watch;
};

/// Assembles the surfaces of a specimen, of which `validate` has said `facts`. Height fields and
/// sheets are continued as far as electrons from the scanned region reach. Throws Interrupted.
SceneSurfaces make_surfaces(const Specimen& specimen, const std::vector<BodyFacts>& facts,
                            const Beam& beam, const Scan& scan, const Physics& physics,
                            const SurfaceOptions& options = {});

}  // namespace surf::mc
