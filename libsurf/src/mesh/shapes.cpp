// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/argument.h"
#include "surf/core/error.h"

namespace surf {
namespace {

void require_range(int value, int lowest, int highest, const char* subject) {
  if (value >= lowest && value <= highest) return;
  throw UsageError(subject, fmt::format("it is {}", value),
                   fmt::format("Give a whole number from {} to {}", lowest, highest));
}

// ---- Box ------------------------------------------------------------------------------------

using Ticks = std::array<std::vector<double>, 3>;

std::vector<double> ticks(double lower, double upper, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(lower + (upper - lower) * i / count);
  values.push_back(upper);
  return values;
}

/// Adds a side of the box perpendicular to `axis`, with vertices of its own; `high`: the upper
/// side.
void add_side(TriangleMesh& mesh, const Ticks& t, std::size_t axis, bool high) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  const auto row = static_cast<std::uint32_t>(t[u].size());
  for (const double at_v : t[v]) {
    for (const double at_u : t[u]) {
      double p[3];
      p[axis] = high ? t[axis].back() : t[axis].front();
      p[u] = at_u;
      p[v] = at_v;
      mesh.vertices_nm.push_back({p[0], p[1], p[2]});
    }
  }
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      std::uint32_t b = a + 1;
      std::uint32_t d = a + row;
      const std::uint32_t c = d + 1;
      if (!high) std::swap(b, d);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
}

// ---- Sphere ---------------------------------------------------------------------------------

TriangleMesh icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices_nm = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& v : mesh.vertices_nm) v = normalized(v);
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Splits every triangle of a unit sphere into four, with one new vertex for the middle of each
/// edge.
TriangleMesh split_sphere(const TriangleMesh& coarse) {
  std::vector<std::uint64_t> edges;
  edges.reserve(coarse.triangles.size() * 3);
  for (const Triangle& t : coarse.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_key(t[k], t[(k + 1) % 3]));
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  TriangleMesh fine;
  fine.vertices_nm = coarse.vertices_nm;
  for (const std::uint64_t edge : edges) {
    fine.vertices_nm.push_back(
        normalized(coarse.vertices_nm[edge >> 32] + coarse.vertices_nm[edge & 0xffffffffu]));
  }
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto found = std::ranges::lower_bound(edges, edge_key(a, b));
    return static_cast<std::uint32_t>(coarse.vertices_nm.size() +
                                      static_cast<std::size_t>(found - edges.begin()));
  };
  fine.triangles.reserve(coarse.triangles.size() * 4);
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

TriangleMesh make_box(const Vec3& lower_nm, const Vec3& upper_nm, int subdivisions) {
  require_range(subdivisions, 1, 10000, "subdivisions");
  const Vec3 size = upper_nm - lower_nm;
  require_positive(size.x, "size of the box along x");
  require_positive(size.y, "size of the box along y");
  require_positive(size.z, "size of the box along z");
  const Ticks t{ticks(lower_nm.x, upper_nm.x, subdivisions),
                ticks(lower_nm.y, upper_nm.y, subdivisions),
                ticks(lower_nm.z, upper_nm.z, subdivisions)};
  TriangleMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_side(mesh, t, axis, false);
    add_side(mesh, t, axis, true);
  }
  return merge_equal_vertices(mesh);
}

TriangleMesh make_sphere(const Vec3& center_nm, double radius_nm, int subdivisions) {
  require_range(subdivisions, 0, 9, "subdivisions");
  require_positive(radius_nm, "radius");
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = split_sphere(mesh);
  transform(mesh, radius_nm, center_nm);
  return mesh;
}

TriangleMesh make_cone(const Vec3& base_nm, double bottom_radius_nm, double top_radius_nm,
                       double height_nm, int segments) {
  require_range(segments, 3, 100000, "segments");
  require_positive(bottom_radius_nm, "bottom radius");
  require_not_negative(top_radius_nm, "top radius");
  require_positive(height_nm, "height of the cone");
  const auto n = static_cast<std::uint32_t>(segments);
  TriangleMesh mesh;
  const auto ring = [&](double radius, double z) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.vertices_nm.push_back(base_nm +
                                 Vec3{radius * std::cos(angle), radius * std::sin(angle), z});
    }
  };
  ring(bottom_radius_nm, 0);
  const bool tip = top_radius_nm == 0;
  if (!tip) ring(top_radius_nm, height_nm);
  const auto bottom = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.push_back(base_nm);
  mesh.vertices_nm.push_back(base_nm + Vec3{0, 0, height_nm});
  const std::uint32_t top = bottom + 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({bottom, next, i});
    if (tip) {
      mesh.triangles.push_back({i, next, top});
      continue;
    }
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
    mesh.triangles.push_back({top, n + i, n + next});
  }
  return mesh;
}

}  // namespace surf
