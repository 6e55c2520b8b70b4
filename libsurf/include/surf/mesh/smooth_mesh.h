// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct SmoothOptions {
  int iterations = 10;  ///< >= 0; 0 changes nothing. One is a step in and a step out

  /// Share of the way to the mean of its neighbours that a vertex goes in the step in; in (0, 1).
  double step = 0.5;

  /// What the two steps leave unchanged: waves of this relative frequency; in (0, 1). The step out
  /// is 1 / (pass_band - 1 / step), Taubin's k_PB. Lower values smooth coarser shapes too.
  double pass_band = 0.1;
};

/// Smooths by Taubin's method (1995, doi:10.1145/218380.218473), which does not shrink bodies as
/// plain averaging does: a step towards the mean of the neighbours, then a longer one away from it.
/// Rims and vertices at non-manifold edges stay where they are. Triangles and the order of vertices
/// stay as they are; vertices at equal places move together. Throws InvalidInput on damaged meshes,
/// UsageError on options out of range.
TriangleMesh smooth_mesh(const TriangleMesh& mesh, const SmoothOptions& options = {});

}  // namespace surf
