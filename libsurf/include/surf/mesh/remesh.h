// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct RemeshOptions {
  double edge_nm = 0;  ///< length of edges that is aimed at, > 0
  /// Triangles whose box does not touch this one stay as they are.
  Box region_nm;
  double sharp_deg = 5;  ///< edges whose faces enclose a larger angle are kept, 0 to 180
  int rounds = 3;        ///< of splitting, collapsing, flipping and relaxing, >= 1
  Watch watch;
};

/// The same surface by triangles of nearly equal edges (Botsch and Kobbelt 2004,
/// doi:10.1145/1057432.1057457): flat faces and sharp edges stay exactly where they are, curved
/// ones to within a small part of an edge's square over the radius. A surface that does not cut
/// itself stays so: where corners would fold, edges are only split. Throws InvalidInput on damaged
/// meshes and edges that more than two triangles share, UsageError for options out of range,
/// Interrupted.
TriangleMesh remesh(const TriangleMesh& mesh, const RemeshOptions& options);

}  // namespace surf
