// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/triangle_tree.h"

namespace surf {

// Exact answers, whatever the rounding, by CGAL's filtered predicates.

bool is_degenerate(const Corners& t);

/// Whether two triangles without a common corner have a point in common.
bool triangles_meet(const Corners& s, const Corners& t);

/// Whether two triangles that share the corner a alone have any other point in common.
bool triangles_meet_beyond_corner(const Corners& s, const Corners& t);

/// Whether two triangles that share the corners a and b lie on each other: one plane, one side.
bool triangles_meet_beyond_edge(const Corners& s, const Corners& t);

}  // namespace surf
