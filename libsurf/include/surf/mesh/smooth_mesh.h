// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/triangle_mesh.h"

namespace surf {

struct SmoothOptions {
  int iterations = 10;  ///< >= 0; 0 changes nothing. An iteration is a step in and a step out

  /// Share of the distance to the mean of its neighbours by which the step in moves a vertex; in
  /// (0, 1).
  double step = 0.5;

  /// Relative frequency of the waves that the two steps leave unchanged, Taubin's k_PB; in (0, 1).
  /// The step out is 1 / (pass_band - 1 / step). Lower values also smooth coarser shapes.
  double pass_band = 0.1;
};

/// Smooths by Taubin's method (1995, doi:10.1145/218380.218473): a step towards the mean of the
/// neighbours, then a longer step away from it. Unlike plain averaging, this does not shrink
/// bodies. Vertices at rims and at non-manifold edges stay where they are. Triangles and the order
/// of vertices do not change; vertices at equal places move together. Throws InvalidInput on
/// damaged meshes, UsageError on options out of range.
TriangleMesh smooth_mesh(const TriangleMesh& mesh, const SmoothOptions& options = {});

}  // namespace surf
