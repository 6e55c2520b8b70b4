// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cgal_predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Kernel/global_functions.h>
#include <CGAL/intersections.h>

namespace surf {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const Vec3& v) { return {v.x, v.y, v.z}; }
Kernel::Triangle_3 triangle(const Corners& t) { return {point(t.a), point(t.b), point(t.c)}; }

}  // namespace

bool is_degenerate(const Corners& t) { return CGAL::collinear(point(t.a), point(t.b), point(t.c)); }

bool triangles_meet(const Corners& s, const Corners& t) {
  return CGAL::do_intersect(triangle(s), triangle(t));
}

bool triangles_meet_beyond_corner(const Corners& s, const Corners& t) {
  return CGAL::do_intersect(triangle(t), Kernel::Segment_3(point(s.b), point(s.c))) ||
         CGAL::do_intersect(triangle(s), Kernel::Segment_3(point(t.b), point(t.c)));
}

bool triangles_meet_beyond_edge(const Corners& s, const Corners& t) {
  return CGAL::coplanar(point(s.a), point(s.b), point(s.c), point(t.c)) &&
         CGAL::coplanar_orientation(point(s.a), point(s.b), point(s.c), point(t.c)) ==
             CGAL::POSITIVE;
}

}  // namespace surf
