// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cgal_fill_hole.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <exception>

#include "surf/core/error.h"

namespace surf {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::size_t max_corners_of_cubic_search = 300;

/// Checks the cancel token between the steps of a search.
struct Looks : CGAL::Polygon_mesh_processing::Hole_filling::Default_visitor {
  const Watch* watch;
  void start_quadratic_phase(std::size_t) const { watch->check(); }
  void quadratic_step() const { watch->check(); }
  void start_cubic_phase(int) const { watch->check(); }
  void cubic_step() const { watch->check(); }
};

/// Whether one of the triangles runs from corner `a` to corner `b`.
bool runs(const std::vector<Triangle>& triangles, std::uint32_t a, std::uint32_t b) {
  return std::ranges::any_of(triangles, [&](const Triangle& t) {
    return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
  });
}

}  // namespace

std::vector<Triangle> span_polygon(const std::vector<Vec3>& corners, const Watch& watch) {
  const auto count = static_cast<std::uint32_t>(corners.size());
  if (count == 3) return {{0, 1, 2}};
  std::vector<Kernel::Point_3> points;
  for (const Vec3& c : corners) points.emplace_back(c.x, c.y, c.z);
  std::vector<CGAL::Triple<int, int, int>> found;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, std::back_inserter(found),
        CGAL::parameters::do_not_use_cubic_algorithm(count > max_corners_of_cubic_search)
            .visitor(Looks{{}, &watch}));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) {
    return {};  // for example, corners on a line
  }
  std::vector<Triangle> triangles;
  for (const auto& t : found) {
    triangles.push_back({static_cast<std::uint32_t>(t.first), static_cast<std::uint32_t>(t.second),
                         static_cast<std::uint32_t>(t.third)});
  }
  if (triangles.size() + 2 != count) return {};
  if (!runs(triangles, 0, 1)) {
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!runs(triangles, i, (i + 1) % count)) return {};
  }
  return triangles;
}

}  // namespace surf
