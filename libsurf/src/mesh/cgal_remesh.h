// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mesh/remesh.h"

namespace surf {

/// CGAL's isotropic remeshing of the triangles that `chosen` says (one for each triangle). The
/// result is empty where edges are shared by more than two triangles, or by two that disagree.
TriangleMesh remesh_chosen(const TriangleMesh& mesh, const std::vector<bool>& chosen,
                           const RemeshOptions& options);

}  // namespace surf
