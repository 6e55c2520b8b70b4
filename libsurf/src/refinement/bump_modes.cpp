// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "surf/mesh/vertex_normals.h"
#include "surf/refinement/mesh_modes.h"

namespace surf {
namespace {

constexpr double reach_over_spacing = 1.8;
// Ways along edges are longer than those on the surface.
constexpr double ways_over_reach = 1.5;

/// Vertices and their distances along edges.
class Ways {
 public:
  explicit Ways(const TriangleMesh& mesh) : mesh_(mesh), first_(mesh.vertices_nm.size() + 1, 0) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) first_[v + 1] += 2;
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    next_.resize(first_.back());
    std::vector<std::size_t> filled(first_.begin(), first_.end() - 1);
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = t[static_cast<std::size_t>(k)];
        next_[filled[v]++] = t[static_cast<std::size_t>((k + 1) % 3)];
        next_[filled[v]++] = t[static_cast<std::size_t>((k + 2) % 3)];
      }
    far_.assign(mesh.vertices_nm.size(), HUGE_VAL);
  }

  /// Calls visit(vertex, distance) for all vertices within `reach` of a vertex.
  template <class Visit>
  void from(std::uint32_t start, double reach, const Visit& visit) {
    using Place = std::pair<double, std::uint32_t>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> open;
    std::vector<std::uint32_t> touched{start};
    far_[start] = 0;
    open.push({0, start});
    while (!open.empty()) {
      const auto [distance, v] = open.top();
      open.pop();
      if (distance > far_[v]) continue;
      visit(v, distance);
      for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) {
        const std::uint32_t w = next_[i];
        const double there = distance + length(mesh_.vertices_nm[w] - mesh_.vertices_nm[v]);
        if (there > reach || there >= far_[w]) continue;
        if (far_[w] == HUGE_VAL) touched.push_back(w);
        far_[w] = there;
        open.push({there, w});
      }
    }
    for (const std::uint32_t v : touched) far_[v] = HUGE_VAL;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> next_;
  std::vector<double> far_;
};

/// Vertices that are at least `spacing` apart, the next one always the farthest from those before.
std::vector<std::uint32_t> middles(const TriangleMesh& mesh, const std::vector<bool>& may_move,
                                   double spacing, Ways& ways) {
  std::vector<std::uint32_t> out;
  const std::size_t n = mesh.vertices_nm.size();
  std::vector<double> nearest(n, HUGE_VAL);
  // One visit of the whole mesh for each would take long: vertices that are out of reach of all
  // come first, in their order.
  const auto take = [&](std::uint32_t v, double reach) {
    out.push_back(v);
    ways.from(v, reach, [&](std::uint32_t w, double distance) {
      nearest[w] = std::min(nearest[w], distance);
    });
  };
  for (double reach : {4.0, 2.0, 1.4, 1.0})
    for (std::size_t v = 0; v < n; ++v)
      if (may_move[v] && nearest[v] > reach * spacing)
        take(static_cast<std::uint32_t>(v), 4 * spacing);
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::vector<MeshMode> bump_modes(const TriangleMesh& mesh, const std::vector<bool>& may_move,
                                 double spacing_nm) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  Ways ways(mesh);
  std::vector<MeshMode> modes;
  std::vector<double> sums(mesh.vertices_nm.size(), 0);
  const double reach = reach_over_spacing * spacing_nm;
  for (const std::uint32_t middle : middles(mesh, may_move, spacing_nm, ways)) {
    MeshMode mode;
    mode.middle_nm = mesh.vertices_nm[middle];
    mode.normal = normals[middle];
    mode.reach_nm = reach;
    ways.from(middle, ways_over_reach * reach, [&](std::uint32_t v, double) {
      const double t = length(mesh.vertices_nm[v] - mode.middle_nm) / reach;
      if (!may_move[v] || t >= 1) return;
      const double size = (1 - t * t) * (1 - t * t);
      sums[v] += size;
      mode.moves.push_back({v, normals[v] * size});
    });
    std::ranges::sort(mode.moves, {}, &MeshMode::Move::vertex);
    modes.push_back(std::move(mode));
  }
  for (MeshMode& mode : modes)
    for (MeshMode::Move& move : mode.moves) move.by *= 1 / sums[move.vertex];
  return modes;
}

}  // namespace surf
