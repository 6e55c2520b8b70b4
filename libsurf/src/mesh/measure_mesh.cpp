// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/measure_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/edges.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

/// Sums over the triangles around each point.
struct Sums {
  std::vector<double> angle;  ///< sum of the angles at the point
  std::vector<double> area;   ///< the point's share of the areas
  std::vector<Vec3> pull;     ///< gradient of the area: half the sum of cotangents times edges
  std::vector<Vec3> normal;
  std::vector<unsigned char> inner;  ///< 1: every edge at the point has two triangles
};

/// The area that corner k gets from a triangle: the part nearest to the corner, or a fixed share if
/// that part extends beyond the triangle (Meyer et al., section 3.3).
double mixed_area(const Vec3* v, std::size_t k, double area) {
  const auto along = [v](std::size_t at) {
    return dot(v[(at + 1) % 3] - v[at], v[(at + 2) % 3] - v[at]);
  };
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  if (along(k) < 0) return area / 2;
  if (along(i) < 0 || along(j) < 0) return area / 4;
  const Vec3 ki = v[i] - v[k], kj = v[j] - v[k];
  return (dot(ki, ki) * along(j) + dot(kj, kj) * along(i)) / (16 * area);
}

Sums sum_up(const TriangleMesh& mesh, const Weld& weld, const std::vector<Triangle>& triangles) {
  const std::size_t points = weld.points();
  Sums s{std::vector<double>(points, 0), std::vector<double>(points, 0), std::vector<Vec3>(points),
         std::vector<Vec3>(points), std::vector<unsigned char>(points, 1)};
  visit_edges(triangles, points, [&](const EdgeUse& edge) {
    if (edge.uses() != 2) s.inner[edge.low] = s.inner[edge.high] = 0;
  });
  for (const Triangle& t : triangles) {
    const Vec3 v[] = {mesh.vertices_nm[weld.first_vertex[t[0]]],
                      mesh.vertices_nm[weld.first_vertex[t[1]]],
                      mesh.vertices_nm[weld.first_vertex[t[2]]]};
    const Vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    const double twice_area = length(normal);
    if (!(twice_area > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const double along = dot(v[i] - v[k], v[j] - v[k]);
      const Vec3 pull = (v[j] - v[i]) * (0.5 * along / twice_area);
      s.pull[t[i]] += pull;
      s.pull[t[j]] -= pull;
      s.angle[t[k]] += std::atan2(twice_area, along);
      s.area[t[k]] += mixed_area(v, k, 0.5 * twice_area);
      s.normal[t[k]] += normal;
    }
  }
  return s;
}

/// The curvature at a point. The mean curvature vector points along `pull`, inward on a ball.
Curvature curvature(const Sums& s, std::size_t p) {
  Curvature c;
  c.area_nm2 = s.area[p];
  if (!s.inner[p] || !(s.area[p] > 0)) return c;
  c.gaussian_per_nm2 = (2 * std::numbers::pi - s.angle[p]) / s.area[p];
  const double mean = 0.5 * length(s.pull[p]) / s.area[p];
  c.mean_per_nm = dot(s.pull[p], s.normal[p]) > 0 ? -mean : mean;
  return c;
}

}  // namespace

MeshMeasures measure_mesh(const TriangleMesh& mesh) {
  const MeshReport report = check_mesh(mesh);
  validate(mesh);
  MeshMeasures m;
  m.bounds_nm = report.bounds_nm;
  m.area_nm2 = report.area_nm2;
  m.volume_nm3 = report.signed_volume_nm3;
  const Weld weld = weld_equal_vertices(mesh);
  const std::vector<Triangle> triangles = welded_triangles(mesh, weld);
  const auto place = [&](std::uint32_t point) {
    return mesh.vertices_nm[weld.first_vertex[point]];
  };
  for (const Triangle& t : triangles) {
    const double area = 0.5 * length(cross(place(t[1]) - place(t[0]), place(t[2]) - place(t[0])));
    m.centroid_nm += (place(t[0]) + place(t[1]) + place(t[2])) * (area / 3);
  }
  if (m.area_nm2 > 0) m.centroid_nm *= 1 / m.area_nm2;
  std::size_t edges = 0;
  m.shortest_edge_nm = HUGE_VAL;
  visit_edges(triangles, weld.points(), [&](const EdgeUse& edge) {
    const double l = length(place(edge.high) - place(edge.low));
    m.shortest_edge_nm = std::min(m.shortest_edge_nm, l);
    m.longest_edge_nm = std::max(m.longest_edge_nm, l);
    m.mean_edge_nm += l;
    ++edges;
  });
  if (edges > 0) m.mean_edge_nm /= static_cast<double>(edges);
  else m.shortest_edge_nm = 0;
  const Sums sums = sum_up(mesh, weld, triangles);
  for (std::size_t p = 0; p < weld.points(); ++p) {
    const Curvature c = curvature(sums, p);
    m.gaussian_integral += c.gaussian_per_nm2 * c.area_nm2;
    m.mean_integral_nm += c.mean_per_nm * c.area_nm2;
  }
  return m;
}

std::vector<Curvature> mesh_curvature(const TriangleMesh& mesh) {
  validate(mesh);
  const Weld weld = weld_equal_vertices(mesh);
  const Sums sums = sum_up(mesh, weld, welded_triangles(mesh, weld));
  std::vector<Curvature> result(mesh.vertices_nm.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (weld.point[v] != Weld::unused) result[v] = curvature(sums, weld.point[v]);
  }
  return result;
}

}  // namespace surf
