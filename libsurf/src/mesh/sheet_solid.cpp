// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/sheet_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/argument.h"
#include "mesh/boundary.h"
#include "mesh/edges.h"
#include "mesh/rim.h"
#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

[[noreturn]] void refuse(const std::string& reason) {
  throw InvalidInput("sheet", reason,
                     "Walls and a base need an open sheet that lies like a landscape");
}

void check_sheet(const TriangleMesh& sheet, const Watch& watch) {
  const MeshReport r = check_mesh(sheet, watch);
  if (r.boundary_edges == 0) refuse("it is closed already");
  if (r.nonmanifold_edges > 0) refuse("more than two triangles meet at an edge");
  if (r.inconsistent_edges > 0) refuse("triangles are turned against each other");
  if (r.nonmanifold_vertices > 0) refuse("parts of it touch in a point only");
}

void check_base(const TriangleMesh& sheet, double base_z_nm) {
  require_finite(base_z_nm, "base");
  const double lowest = bounds(sheet).lower_nm.z;
  if (base_z_nm < lowest) return;
  throw UsageError("base",
                   fmt::format("{} nm is not below the lowest height, {} nm", base_z_nm, lowest),
                   "Give a lower base");
}

void check_no_overhang(const TriangleMesh& sheet) {
  for (const Triangle& t : sheet.triangles) {
    const Vec3 a = sheet.vertices_nm[t[0]], b = sheet.vertices_nm[t[1]],
               c = sheet.vertices_nm[t[2]];
    if (cross_xy(b - a, c - a) > 0) continue;
    refuse(fmt::format("it has holes or a ragged rim, and overhangs near ({:.6g}, {:.6g}) nm", a.x,
                       a.y));
  }
}

}  // namespace

TriangleMesh sheet_solid(const TriangleMesh& sheet, double base_z_nm, const Watch& watch) {
  validate(sheet, "sheet");
  check_sheet(sheet, watch.part(0, 0.7));
  check_base(sheet, base_z_nm);
  const Weld weld = weld_equal_vertices(sheet);
  std::vector<BoundaryLoop> rims = boundary_loops(welded_triangles(sheet, weld), weld.points());
  for (BoundaryLoop& rim : rims)
    for (std::uint32_t& point : rim.points) point = weld.first_vertex[point];
  watch.report(0.8, 1);
  TriangleMesh solid = sheet;
  for (Triangle& t : solid.triangles)
    for (std::uint32_t& v : t) v = weld.first_vertex[weld.point[v]];
  const std::size_t sheet_triangles = solid.triangles.size();

  watch.report(0.9, 1);
  std::vector<std::uint32_t> below(solid.vertices_nm.size(), none);
  const auto add_below = [&](std::uint32_t vertex) {
    if (below[vertex] != none) return;
    below[vertex] = static_cast<std::uint32_t>(solid.vertices_nm.size());
    const Vec3 v = solid.vertices_nm[vertex];
    solid.vertices_nm.push_back({v.x, v.y, base_z_nm});
  };
  for (const BoundaryLoop& rim : rims) {
    for (const std::uint32_t v : rim.points) add_below(v);
    for (std::size_t i = 0; i < rim.points.size(); ++i) {
      const std::uint32_t a = rim.points[i], b = rim.points[(i + 1) % rim.points.size()];
      solid.triangles.push_back({a, below[a], below[b]});
      solid.triangles.push_back({a, below[b], b});
    }
  }

  std::vector<Vec3> corners;
  if (rims.size() == 1)
    for (const std::uint32_t v : rims[0].points) corners.push_back(solid.vertices_nm[v]);
  const RimCentroid c = corners.empty() ? RimCentroid{} : rim_centroid(corners);
  if (c.area > 0 && !star_angles(corners, c).empty()) {
    const auto middle = static_cast<std::uint32_t>(solid.vertices_nm.size());
    solid.vertices_nm.push_back({c.x, c.y, base_z_nm});
    const std::vector<std::uint32_t>& rim = rims[0].points;
    for (std::size_t i = 0; i < rim.size(); ++i)
      solid.triangles.push_back({middle, below[rim[(i + 1) % rim.size()]], below[rim[i]]});
    return solid;
  }
  check_no_overhang(sheet);
  for (std::size_t t = 0; t < sheet_triangles; ++t) {
    const Triangle top = solid.triangles[t];
    for (const std::uint32_t v : top) add_below(v);
    solid.triangles.push_back({below[top[0]], below[top[2]], below[top[1]]});
  }
  return solid;
}

}  // namespace surf
