// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct RepairOptions {
  /// Rim vertices closer together than this are merged if that closes gaps; >= 0, 0: only vertices
  /// at equal places. Default: 1e-6 of the mesh's diagonal, the rounding of single precision.
  std::optional<double> stitch_nm;

  /// Triangles flatter than this are slivers and are removed by flipping or collapsing an edge;
  /// >= 0. 0: only triangles without area (as `check_mesh` counts them).
  double sliver_nm = 0;

  /// Holes with a longer rim stay open; >= 0, 0 fills none. Default: the diagonal of the component
  /// that has the hole. A sheet's own rim is at least twice as long, so sheets stay open.
  std::optional<double> max_hole_nm;

  /// Components whose box has a shorter diagonal are removed; >= 0, 0 keeps all.
  double min_component_nm = 0;

  bool resolve_self_intersections = true;  ///< false: only count them
  int threads = 0;                         ///< 0: one per hardware thread; same result
  Watch watch;
};
/// Describes the parameters mesh.stitch, mesh.sliver and so on.
void describe(ParameterVisitor& visit, RepairOptions& options);

/// A hole that was left open.
struct OpenHole {
  Vec3 place_nm;  ///< a point of its rim
  double perimeter_nm = 0;
  std::size_t edges = 0;
  bool too_large = false;  ///< longer than the limit; false: no fill fits
};

struct RepairSummary {
  MeshReport before;
  MeshReport after;
  std::size_t merged_vertices = 0;     ///< vertices at equal places
  std::size_t stitched_vertices = 0;   ///< vertices within stitch_nm of each other
  std::size_t removed_degenerate = 0;  ///< triangles without area, and slivers
  /// Copies, and both triangles of a pair of opposite orientation.
  std::size_t removed_duplicates = 0;
  std::size_t turned_triangles = 0;
  std::size_t dropped_components = 0;
  std::size_t filled_holes = 0;
  std::size_t fill_triangles = 0;
  std::vector<OpenHole> open_holes;
  /// Pairs of intersecting triangles after the steps above, counted up to 100,000.
  std::size_t self_intersections_before = 0;
  std::size_t self_intersections_after = 0;
  Vec3 first_self_intersection_nm;  ///< of the remaining ones, if there are any

  bool changed = false;  ///< false: the mesh is unchanged, to the last bit

  /// Whether the mesh is closed and oriented with outward normals, and has no degenerate or
  /// duplicate triangles and no self-intersections.
  bool sound() const;
};

struct RepairedMesh {
  TriangleMesh mesh;
  RepairSummary summary;
};

/// Repairs a mesh, in this order: merges equal vertices, stitches gaps, removes degenerate and
/// duplicate triangles, turns triangles so that neighbours agree, removes tiny components, fills
/// holes, resolves self-intersections, and turns closed components outward (cavities stay inward).
/// A step is undone if it leaves more open, non-manifold or inconsistent edges than before. A mesh
/// without faults is returned unchanged. The summary lists what could not be repaired.
///
/// Deterministic. Takes seconds for a million triangles, if there are few self-intersections.
/// Throws InvalidInput on damaged meshes (`validate`), UsageError on options out of range,
/// Interrupted.
RepairedMesh repair_mesh(const TriangleMesh& mesh, const RepairOptions& options = {});

/// The repairs and the remaining faults, one line each, for people.
std::vector<std::string> describe(const RepairSummary& summary);

}  // namespace surf
