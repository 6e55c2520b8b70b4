// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cgal_triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

enum class Where : std::uint8_t { unknown, inside, outside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<Where, Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Face = Triangulation::Face_handle;

// Assigns `where` to all faces that can be reached without crossing a constraint. Returns false on
// a contradiction.
bool spread(std::vector<Face>& open, Where where) {
  while (!open.empty()) {
    const Face face = open.back();
    open.pop_back();
    if (face->info() != Where::unknown) {
      if (face->info() != where) return false;
      continue;
    }
    face->info() = where;
    for (int i = 0; i < 3; ++i)
      if (!face->is_constrained(i)) open.push_back(face->neighbor(i));
  }
  return true;
}

// A triangle is bad if the radius of its circumcircle exceeds this times its shortest side.
constexpr double largest_ratio = 2;
// Least distance of other points from a new point, in circumradii.
constexpr double closest = 0.6;
constexpr int most_passes = 40;

struct NewPoint {
  Kernel::Point_2 place;
  double squared_radius;
};

std::vector<NewPoint> middles_of_bad(const Triangulation& triangulation) {
  std::vector<NewPoint> out;
  for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f) {
    if (f->info() != Where::inside) continue;
    const auto &a = f->vertex(0)->point(), &b = f->vertex(1)->point(), &c = f->vertex(2)->point();
    const double shortest = std::min(
        {CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)});
    const double bax = b.x() - a.x(), bay = b.y() - a.y(), cax = c.x() - a.x(), cay = c.y() - a.y();
    const double area2 = bax * cay - bay * cax, bb = bax * bax + bay * bay,
                 cc = cax * cax + cay * cay;
    const double x = (cay * bb - bay * cc) / (2 * area2), y = (bax * cc - cax * bb) / (2 * area2);
    const double squared = x * x + y * y;
    if (!std::isfinite(squared) || squared <= largest_ratio * largest_ratio * shortest) continue;
    out.push_back({Kernel::Point_2(a.x() + x, a.y() + y), squared});
  }
  return out;
}

// Whether a new point may lie in this face. It must not see an edge of an outline under a right
// angle or more, and must not be near other points.
bool has_room(const Triangulation& triangulation, const Face& face, const NewPoint& p) {
  if (triangulation.is_infinite(face) || face->info() != Where::inside) return false;
  for (int i = 0; i < 3; ++i) {
    const auto &a = face->vertex(Triangulation::ccw(i))->point(),
               &b = face->vertex(Triangulation::cw(i))->point();
    if (CGAL::squared_distance(p.place, a) < closest * closest * p.squared_radius) return false;
    if (face->is_constrained(i) && CGAL::angle(a, p.place, b) != CGAL::ACUTE) return false;
  }
  return true;
}

void grade(Triangulation& triangulation, std::vector<std::array<double, 2>>& points) {
  for (int pass = 0; pass < most_passes; ++pass) {
    bool any = false;
    Face hint;
    for (const NewPoint& p : middles_of_bad(triangulation)) {
      const Face face = triangulation.locate(p.place, hint);
      hint = face;
      if (!has_room(triangulation, face, p)) continue;
      const auto vertex = triangulation.insert(p.place, face);
      vertex->info() = static_cast<std::uint32_t>(points.size());
      points.push_back({p.place.x(), p.place.y()});
      auto around = triangulation.incident_faces(vertex);
      const auto begin = around;
      do around->info() = Where::inside;
      while (++around != begin);
      hint = vertex->face();
      any = true;
    }
    if (!any) return;
  }
}

}  // namespace

std::vector<Triangle> triangulate_region(std::vector<std::array<double, 2>>& points,
                                         const std::vector<PlanarEdge>& edges, bool graded) {
  Triangulation triangulation;
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> all;
  for (const auto& p : points)
    all.emplace_back(Kernel::Point_2(p[0], p[1]), static_cast<std::uint32_t>(all.size()));
  triangulation.insert(all.begin(), all.end());
  if (triangulation.number_of_vertices() != points.size()) return {};
  std::vector<Triangulation::Vertex_handle> vertices(points.size());
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end();
       ++v)
    vertices[v->info()] = v;
  try {
    for (const PlanarEdge& e : edges)
      triangulation.insert_constraint(vertices[e.from], vertices[e.to]);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return {};
  }
  for (auto f = triangulation.all_faces_begin(); f != triangulation.all_faces_end(); ++f)
    f->info() = Where::unknown;
  std::vector<Face> open;
  for (const PlanarEdge& e : edges) {
    Face face;
    int opposite = 0;
    // The region's edges must not be split by a point on them.
    if (!triangulation.is_edge(vertices[e.from], vertices[e.to], face, opposite)) return {};
    // `face` lies to the left of the edge as CGAL returns it, which may be in either direction.
    const bool found_forward = face->vertex(Triangulation::ccw(opposite)) == vertices[e.from];
    const Face left = found_forward ? face : face->neighbor(opposite),
               right = found_forward ? face->neighbor(opposite) : face;
    open.assign(1, left);
    if (triangulation.is_infinite(left) || !spread(open, Where::inside)) return {};
    open.assign(1, right);
    if (!spread(open, Where::outside)) return {};
  }
  if (graded) grade(triangulation, points);
  std::vector<Triangle> out;
  for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f)
    if (f->info() == Where::inside)
      out.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return out;
}

}  // namespace surf
