// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// At least one of the two limits must be given.
struct SimplifyOptions {
  /// No sample of either surface is farther from the other one; > 0, or 0: no such limit.
  double tolerance_nm = 0;
  /// Ends at this number of triangles; 0: as few as the tolerance allows.
  std::size_t triangles = 0;
  std::vector<Vec3> fixed_nm;  ///< vertices at exactly these places stay where they are
  int threads = 0;             ///< of the measurement; 0: one per hardware thread. Same result
  Watch watch;
};
/// mesh.mesh_tolerance and mesh.triangles.
void describe(ParameterVisitor& visit, SimplifyOptions& options);

struct SimplifySummary {
  std::size_t triangles_before = 0;
  std::size_t triangles_after = 0;
  MeshDeviation
      deviation;         ///< of the original (first) and the result (second), measured afterwards
  int attempts = 0;      ///< runs, each measured
  bool reached = false;  ///< the number of triangles asked for; true if none was
};

struct SimplifiedMesh {
  TriangleMesh mesh;
  SimplifySummary summary;
};

/// Removes vertices where they matter least (quadric error, Garland and Heckbert 1997,
/// doi:10.1145/258734.258849), one at a time into a neighbour, so that what remains are vertices of
/// the original. Faces do not turn over; closedness, components and holes are kept. Vertices at
/// rims and non-manifold edges stay where they are, and so do those of more than 64 triangles and
/// those asked for. With a tolerance, the number of triangles is cut to a quarter again and again
/// as long as the two-sided deviation from the original, measured anew each time, allows, and the
/// last step is refined by bisection. What comes back is within the tolerance at every sample, in
/// the worst case because nothing was removed.
///
/// Deterministic. Throws InvalidInput on damaged meshes, UsageError if no limit is given or one is
/// out of range, Interrupted.
SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, const SimplifyOptions& options);

}  // namespace surf
