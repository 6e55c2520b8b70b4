// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/mesh/distance_bound.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// At least one of the two limits must be given.
struct SimplifyOptions {
  /// Largest distance of any point of either surface from the other surface; > 0, or 0: no such
  /// limit.
  double tolerance_nm = 0;
  /// Number of triangles to stop at; 0: as few as the tolerance allows.
  std::size_t triangles = 0;
  std::vector<Vec3> fixed_nm;  ///< vertices at exactly these places are kept
  int threads = 0;  ///< for the proof; 0: one per hardware thread. Does not change the result
  Watch watch;
};
/// Describes the parameters mesh.mesh_tolerance and mesh.triangles.
void describe(ParameterVisitor& visit, SimplifyOptions& options);

/// Why no more vertices were removed.
enum class SimplifyEnd {
  triangles,     ///< the wanted number of triangles is reached
  no_candidate,  ///< every further vertex would break the tolerance or turn a face over
  not_proven,    ///< no simpler mesh could be proven to keep the tolerance: nothing is removed
};

struct SimplifySummary {
  std::size_t triangles_before = 0;
  std::size_t triangles_after = 0;
  /// From the original (first) to the result (second): proven afterwards (distance_bound.h). At
  /// most 1 % more than the distance. With a tolerance it is never larger than that.
  DistanceBound deviation;
  int attempts = 0;  ///< decimations, each followed by a proof; all but the first restore
  /// Triangles near which a proof failed, and vertices were restored.
  std::size_t restored = 0;
  SimplifyEnd end = SimplifyEnd::no_candidate;
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
/// vertices are kept.
///
/// With a tolerance, a vertex is removed only where the vertices removed before and the original's
/// edges stay near the new triangles. Afterwards the two-sided distance is proven for every point
/// of both surfaces (distance_bound.h), and near triangles for which the proof fails, vertices are
/// restored until it holds. If it never does, as for coordinates whose squares overflow, nothing is
/// removed (SimplifyEnd::not_proven). Triangles with a repeated corner bound nothing; they are
/// dropped, and the distance is that of the rest.
///
/// Deterministic. Throws InvalidInput on damaged meshes, UsageError if no limit is given or one is
/// out of range, Interrupted.
SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, const SimplifyOptions& options);

}  // namespace surf
