// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/open_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/argument.h"
#include "mesh/boundary.h"
#include "mesh/rim.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

std::string place(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) nm", p.x, p.y, p.z);
}

/// The reason why the mesh is no sheet, or an empty text.
std::string fault(const MeshReport& r) {
  if (r.boundary_edges == 0) return "it has no rim, it is closed";
  if (r.nonmanifold_edges > 0) {
    return "more than two triangles meet at an edge near " + place(r.first_nonmanifold_nm);
  }
  if (r.inconsistent_edges > 0) {
    return "triangles are turned against each other near " + place(r.first_inconsistent_nm);
  }
  if (r.nonmanifold_vertices > 0) {
    return "parts of it touch in a point only, at " + place(r.first_nonmanifold_vertex_nm);
  }
  return "";
}

/// Distance from the centroid to the farthest corner of the box, seen from above.
double reach(const Box& box, const RimCentroid& c) {
  return std::hypot(std::max(c.x - box.lower_nm.x, box.upper_nm.x - c.x),
                    std::max(c.y - box.lower_nm.y, box.upper_nm.y - c.y));
}

// Share of the rim's size; a mesh that extends farther is a body with a hole.
constexpr double beyond_rim = 0.01;

/// A vertex of the sheet that lies well outside the rim, seen from above, or nothing. The rim runs
/// counter-clockwise about the centroid; `angle` holds the angles between neighbours.
std::optional<Vec3> beyond(const TriangleMesh& mesh, std::uint32_t of_triangle,
                           const std::vector<Vec3>& rim, const RimCentroid& c,
                           const std::vector<double>& angle) {
  Box box;
  for (const Vec3& v : rim) box.extend(v);
  const Vec3 size = box.size_nm();
  const double slack = beyond_rim * std::max(size.x, size.y);
  std::vector<double> turned{0};  // angle from the first rim vertex
  for (const double a : angle) turned.push_back(turned.back() + a);
  const Vec3 start = rim[0] - Vec3{c.x, c.y, 0};

  const std::vector<std::uint32_t> component = triangle_components(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (component[t] != component[of_triangle]) continue;
    for (const std::uint32_t corner : mesh.triangles[t]) {
      const Vec3& v = mesh.vertices_nm[corner];
      const Vec3 d = v - Vec3{c.x, c.y, 0};
      double turn = std::atan2(cross_xy(start, d), start.x * d.x + start.y * d.y);
      if (turn < 0) turn += 2 * std::numbers::pi;
      const auto after = std::upper_bound(turned.begin() + 1, turned.end() - 1, turn);
      const auto i = static_cast<std::size_t>(after - turned.begin()) - 1;
      const Vec3 p = rim[i], q = rim[(i + 1) % rim.size()];
      const double outside = -cross_xy(q - p, v - p) / std::hypot(q.x - p.x, q.y - p.y);
      if (outside > slack) return v;
    }
  }
  return std::nullopt;
}

void turn_component(TriangleMesh& mesh, std::uint32_t of_triangle) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (component[t] == component[of_triangle])
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

}  // namespace

std::optional<TriangleMesh> extend_open_sheet(const TriangleMesh& mesh, double apron_nm,
                                              std::string& reason) {
  require_positive(apron_nm, "apron");
  validate(mesh);
  const auto refuse = [&reason](std::string why) {
    reason = std::move(why);
    return std::nullopt;
  };
  if (std::string why = fault(check_mesh(mesh)); !why.empty()) return refuse(std::move(why));
  TriangleMesh result = merge_equal_vertices(mesh);
  std::vector<BoundaryLoop> loops = boundary_loops(result.triangles, result.vertices_nm.size());
  if (loops.size() != 1) {
    return refuse(fmt::format("it has {} rims, one of them near {}", loops.size(),
                              place(result.vertices_nm[loops[1].points[0]])));
  }

  std::vector<std::uint32_t>& rim = loops[0].points;
  const auto positions = [&] {
    std::vector<Vec3> corners;
    for (const std::uint32_t v : rim) corners.push_back(result.vertices_nm[v]);
    return corners;
  };
  const RimCentroid c = rim_centroid(positions());
  if (c.area < 0) {
    turn_component(result, loops[0].sides[0] / 3);
    std::ranges::reverse(rim);
  }
  const std::vector<double> angle = star_angles(positions(), c);
  if (angle.empty()) {
    return refuse("seen from above, its rim is not star-shaped about its centroid, " +
                  fmt::format("({:.6g}, {:.6g}) nm", c.x, c.y));
  }

  if (const auto v = beyond(result, loops[0].sides[0] / 3, positions(), c, angle)) {
    return refuse("it reaches sideways beyond its rim, to " + place(*v));
  }

  // A chord between two directions stays outside the circle of radius `far` if its ends are at a
  // distance of at least far / cos(half the angle between them).
  const double far = reach(bounds(result), c) + apron_nm;
  const auto count = static_cast<std::uint32_t>(rim.size());
  const auto first = static_cast<std::uint32_t>(result.vertices_nm.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const double widest = std::max(angle[i], angle[(i + count - 1) % count]);
    Vec3 v = result.vertices_nm[rim[i]];
    const double factor = far / std::cos(0.5 * widest) / std::hypot(v.x - c.x, v.y - c.y);
    v.x = c.x + (v.x - c.x) * factor;
    v.y = c.y + (v.y - c.y) * factor;
    result.vertices_nm.push_back(v);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    result.triangles.push_back({rim[i], first + i, first + next});
    result.triangles.push_back({rim[i], first + next, rim[next]});
  }
  return result;
}

}  // namespace surf
