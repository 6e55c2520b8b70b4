// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/remesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "mesh/cgal_remesh.h"
#include "surf/core/error.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {
namespace {

// Triangles that reach into the region from far outside are split to this many edges first, so that
// what is outside stays coarse.
constexpr double coarse_edges = 4;
constexpr double longest_edges = 1.5;  // where edges are only split

bool touches(const TriangleMesh& mesh, const Triangle& t, const Box& region) {
  Box box;
  for (const std::uint32_t v : t) box.extend(mesh.vertices_nm[v]);
  return overlap(box, region);
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(const Triangle& t, std::size_t k) { return std::minmax({t[k], t[(k + 1) % 3]}); }

/// Halves edges that are longer than the limit, of triangles that touch the region: in each pass of
/// every triangle at most one, the longest first.
void split_long(TriangleMesh& mesh, const Box& region, double limit_nm, const Watch& watch) {
  const auto length_of = [&](const Edge& e) {
    return length(mesh.vertices_nm[e.first] - mesh.vertices_nm[e.second]);
  };
  for (;;) {
    watch.check();
    std::map<Edge, std::vector<std::size_t>> owners;
    std::vector<std::pair<double, Edge>> wanted;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      std::pair<double, Edge> longest{0, {}};
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge e = edge_of(mesh.triangles[t], k);
        owners[e].push_back(t);
        longest = std::max(longest, {length_of(e), e});
      }
      if (longest.first > limit_nm && touches(mesh, mesh.triangles[t], region))
        wanted.push_back(longest);
    }
    if (wanted.empty()) return;
    std::ranges::sort(wanted, std::greater<>());
    std::vector<bool> taken(mesh.triangles.size(), false);
    for (const auto& [size, e] : wanted) {
      const std::vector<std::size_t>& sides = owners[e];
      if (std::ranges::any_of(sides, [&](std::size_t t) { return taken[t]; })) continue;
      const auto middle = static_cast<std::uint32_t>(mesh.vertices_nm.size());
      mesh.vertices_nm.push_back((mesh.vertices_nm[e.first] + mesh.vertices_nm[e.second]) * 0.5);
      for (const std::size_t t : sides) {
        taken[t] = true;
        Triangle first = mesh.triangles[t], second = first;
        std::ranges::replace(first, e.first, middle);
        std::ranges::replace(second, e.second, middle);
        mesh.triangles[t] = first;
        mesh.triangles.push_back(second);
      }
    }
  }
}

}  // namespace

TriangleMesh remesh(const TriangleMesh& mesh, const RemeshOptions& o) {
  validate(mesh);
  if (!(o.edge_nm > 0) || !std::isfinite(o.edge_nm))
    throw UsageError("edge", "a length above 0 is needed", "Say one, as 5nm");
  if (!(o.sharp_deg >= 0 && o.sharp_deg <= 180))
    throw UsageError("sharp edges", "the angle is out of range", "Give 0 to 180 degrees");
  if (o.rounds < 1) throw UsageError("rounds", "at least one is needed", "Give 1 or more");
  TriangleMesh whole = merge_equal_vertices(mesh);
  split_long(whole, o.region_nm, coarse_edges * o.edge_nm, o.watch);
  std::vector<bool> chosen(whole.triangles.size());
  bool any = false;
  for (std::size_t t = 0; t < chosen.size(); ++t) {
    chosen[t] = touches(whole, whole.triangles[t], o.region_nm);
    any = any || chosen[t];
  }
  if (!any) return whole;
  const auto cuts_itself = [&](const TriangleMesh& m) {
    return !find_self_intersections(m, {.limit = 1, .watch = {{}, o.watch.cancel}}).pairs.empty();
  };
  // Corners that are rounder than an edge is long may fold over in later rounds.
  for (RemeshOptions fewer = o; fewer.rounds >= 1; --fewer.rounds) {
    TriangleMesh out = remesh_chosen(whole, chosen, fewer);
    if (out.triangles.empty())
      throw InvalidInput("mesh", "more than two triangles share an edge, or neighbours disagree",
                         "Repair it first");
    if (!cuts_itself(out)) return out;
  }
  split_long(whole, o.region_nm, longest_edges * o.edge_nm, o.watch);
  return whole;
}

}  // namespace surf
