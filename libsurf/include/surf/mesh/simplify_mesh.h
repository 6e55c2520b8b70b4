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
  /// Largest distance of a sample of either surface from the other surface; > 0, or 0: no such
  /// limit.
  double tolerance_nm = 0;
  /// Number of triangles to stop at; 0: as few as the tolerance allows.
  std::size_t triangles = 0;
  std::vector<Vec3> fixed_nm;  ///< vertices at exactly these places are kept
  int threads = 0;  ///< for the measurement; 0: one per hardware thread. Does not change the result
  Watch watch;
};
/// Describes the parameters mesh.mesh_tolerance and mesh.triangles.
void describe(ParameterVisitor& visit, SimplifyOptions& options);

struct SimplifySummary {
  std::size_t triangles_before = 0;
  std::size_t triangles_after = 0;
  /// From the original (first) to the result (second), measured afterwards.
  MeshDeviation deviation;
  int attempts = 0;  ///< runs of the decimation, each followed by a measurement
  /// Whether the wanted number of triangles was reached; true if none was given.
  bool reached = false;
};

struct SimplifiedMesh {
  TriangleMesh mesh;
  SimplifySummary summary;
};

/// Removes vertices where they matter least (quadric error, Garland and Heckbert 1997,
/// doi:10.1145/258734.258849). Each vertex is merged into a neighbour, so the remaining vertices
/// are vertices of the original. Faces do not turn over; closedness, components and holes are kept.
/// Vertices at rims and non-manifold edges, vertices with more than 64 triangles and the `fixed_nm`
/// vertices are kept. With a tolerance, the number of triangles is repeatedly cut to a quarter as
/// long as the two-sided deviation from the original, measured after each cut, allows it; the last
/// step is refined by bisection. The result is within the tolerance at every sample; in the worst
/// case nothing is removed.
///
/// Deterministic. Throws InvalidInput on damaged meshes, UsageError if no limit is given or one is
/// out of range, Interrupted.
SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, const SimplifyOptions& options);

}  // namespace surf
