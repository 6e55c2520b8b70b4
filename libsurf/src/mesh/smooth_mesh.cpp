// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/smooth_mesh.h"

#include <cmath>
#include <utility>

#include "mesh/edges.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

// Sums of neighbours stay finite.
constexpr double most_coordinate = 1e150;

void require_share(double value, const char* subject) {
  if (value > 0 && value < 1) return;
  throw UsageError(subject, "it is " + format_exact(value), "Give a number between 0 and 1");
}

/// The edges between points, each pair once, and the points that may move.
struct Net {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<double> share;  ///< 1 / number of neighbours; 0: the point stays
};

Net make_net(const std::vector<Triangle>& triangles, std::size_t points) {
  Net net;
  std::vector<std::uint32_t> degree(points, 0);
  std::vector<unsigned char> fixed(points, 0);
  visit_edges(triangles, points, [&](const EdgeUse& edge) {
    net.edges.emplace_back(edge.low, edge.high);
    ++degree[edge.low];
    ++degree[edge.high];
    if (edge.uses() != 2) fixed[edge.low] = fixed[edge.high] = 1;
  });
  for (std::size_t p = 0; p < points; ++p) {
    net.share.push_back(fixed[p] || degree[p] == 0 ? 0 : 1.0 / degree[p]);
  }
  return net;
}

void step(const Net& net, double factor, std::vector<Vec3>& place, std::vector<Vec3>& pull) {
  pull.assign(place.size(), Vec3{});
  for (const auto& [a, b] : net.edges) {
    const Vec3 d = place[b] - place[a];
    pull[a] += d;
    pull[b] -= d;
  }
  for (std::size_t p = 0; p < place.size(); ++p) place[p] += pull[p] * (factor * net.share[p]);
}

}  // namespace

TriangleMesh smooth_mesh(const TriangleMesh& mesh, const SmoothOptions& options) {
  if (options.iterations < 0) {
    throw UsageError("smoothing iterations", "it is " + std::to_string(options.iterations),
                     "Give 0 or more");
  }
  require_share(options.step, "smoothing step");
  require_share(options.pass_band, "pass band");
  validate(mesh);
  for (const Vec3& v : mesh.vertices_nm)
    if (!(std::abs(v.x) <= most_coordinate && std::abs(v.y) <= most_coordinate &&
          std::abs(v.z) <= most_coordinate))
      throw InvalidInput("mesh", "it has coordinates beyond 1e150 nm: they cannot be averaged",
                         "Check the unit of the mesh");
  const Weld weld = weld_equal_vertices(mesh);
  const Net net = make_net(welded_triangles(mesh, weld), weld.points());
  std::vector<Vec3> place, pull;
  for (const std::uint32_t v : weld.first_vertex) place.push_back(mesh.vertices_nm[v]);
  const double outward = 1 / (options.pass_band - 1 / options.step);
  for (int i = 0; i < options.iterations; ++i) {
    step(net, options.step, place, pull);
    step(net, outward, place, pull);
  }
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < result.vertices_nm.size(); ++v) {
    if (weld.point[v] != Weld::unused) result.vertices_nm[v] = place[weld.point[v]];
  }
  return result;
}

}  // namespace surf
