// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mesh/triangle_tree.h"

namespace surf {

// Exact predicates, by CGAL's filtered arithmetic.

bool is_degenerate(const Corners& t);

/// Whether two triangles without a common corner have any common point.
bool triangles_meet(const Corners& s, const Corners& t);

/// Whether two triangles that share only the corner a have any other common point.
bool triangles_meet_beyond_corner(const Corners& s, const Corners& t);

/// Whether two triangles that share the corners a and b overlap: they lie in one plane, on the same
/// side of the edge.
bool triangles_meet_beyond_edge(const Corners& s, const Corners& t);

}  // namespace surf
