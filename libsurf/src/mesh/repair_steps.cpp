// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/repair_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>

#include "mesh/disjoint_sets.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

double area(const TriangleMesh& mesh, const Triangle& t) {
  return 0.5 * length(cross(mesh.vertices_nm[t[1]] - mesh.vertices_nm[t[0]],
                            mesh.vertices_nm[t[2]] - mesh.vertices_nm[t[0]]));
}

/// Six times the volume of the tetrahedron from `origin` to a triangle.
double volume(const TriangleMesh& mesh, const Triangle& t, const Vec3& origin) {
  return dot(mesh.vertices_nm[t[0]] - origin,
             cross(mesh.vertices_nm[t[1]] - origin, mesh.vertices_nm[t[2]] - origin));
}

/// A spatial hash of points in cubes of a given width.
class CubeGrid {
 public:
  explicit CubeGrid(double width_nm) : width_nm_(width_nm) {}

  void add(const Vec3& p, std::uint32_t index) { cubes_[key(cell(p))].push_back(index); }

  template <class Visit>
  void visit_near(const Vec3& p, const Visit& visit) const {
    const Vec3 c = cell(p);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto found = cubes_.find(key(c + Vec3{double(dx), double(dy), double(dz)}));
          if (found == cubes_.end()) continue;
          for (const std::uint32_t i : found->second) visit(i);
        }
      }
    }
  }

 private:
  Vec3 cell(const Vec3& p) const {
    return {std::floor(p.x / width_nm_), std::floor(p.y / width_nm_), std::floor(p.z / width_nm_)};
  }
  // Different cubes with equal keys only cost time.
  static std::uint64_t key(const Vec3& c) {
    std::uint64_t h = 0;
    for (const double v : {c.x, c.y, c.z}) {
      h = (h ^ std::bit_cast<std::uint64_t>(v + 0.0)) * 0x9e3779b97f4a7c15u;  // -0 is 0
      h ^= h >> 29;
    }
    return h;
  }
  double width_nm_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cubes_;
};

std::vector<std::uint32_t> rim_points(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> points;
  visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() != 1) return;
    points.push_back(edge.low);
    points.push_back(edge.high);
  });
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Patches of triangles that are connected by edges of exactly two triangles, and the triangles to
/// be turned within them.
struct Patches {
  std::vector<std::uint32_t> patch;  ///< patch of every triangle, from 0
  std::vector<unsigned char> turn;   ///< 1: oriented against the first triangle of its patch
  std::uint32_t count = 0;
};

struct Neighbour {
  std::uint32_t triangle = Weld::unused;
  bool agrees = true;
};

std::vector<std::array<Neighbour, 3>> neighbours(const TriangleMesh& mesh) {
  std::vector<std::array<Neighbour, 3>> result(mesh.triangles.size());
  visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() != 2) return;
    const Side a = edge.side(0), b = edge.side(1);
    const bool agrees = count_forward(mesh.triangles, edge) == 1;
    result[a / 3][a % 3] = {b / 3, agrees};
    result[b / 3][b % 3] = {a / 3, agrees};
  });
  return result;
}

Patches find_patches(const TriangleMesh& mesh) {
  const auto next = neighbours(mesh);
  const std::size_t triangles = mesh.triangles.size();
  Patches p{std::vector<std::uint32_t>(triangles, Weld::unused),
            std::vector<unsigned char>(triangles, 0), 0};
  std::vector<std::uint32_t> queue;
  for (std::uint32_t first = 0; first < triangles; ++first) {
    if (p.patch[first] != Weld::unused) continue;
    queue.assign(1, first);
    p.patch[first] = p.count;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const Neighbour& n : next[queue[i]]) {
        if (n.triangle == Weld::unused || p.patch[n.triangle] != Weld::unused) continue;
        p.patch[n.triangle] = p.count;
        p.turn[n.triangle] = p.turn[queue[i]] ^ !n.agrees;
        queue.push_back(n.triangle);
      }
    }
    ++p.count;
  }
  return p;
}

/// Turns over whole patches if that leaves fewer unpaired sides at non-manifold edges.
void balance_patches(const TriangleMesh& mesh, Patches& p) {
  struct Use {
    std::uint32_t patch;
    int direction;
  };
  std::vector<std::vector<Use>> edges;
  std::vector<std::vector<std::size_t>> edges_of(p.count);
  visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (edge.uses() < 3) return;
    edges.emplace_back();
    for (std::size_t i = 0; i < edge.uses(); ++i) {
      const Side s = edge.side(i);
      const bool forward = (side_begin(mesh.triangles, s) == edge.low) != (p.turn[s / 3] != 0);
      edges.back().push_back({p.patch[s / 3], forward ? 1 : -1});
      edges_of[p.patch[s / 3]].push_back(edges.size() - 1);
    }
  });
  std::vector<unsigned char> over(p.count, 0);
  const auto imbalance = [&](std::uint32_t patch) {
    int sum = 0;
    for (const std::size_t e : edges_of[patch]) {
      int net = 0;
      for (const Use& use : edges[e]) net += over[use.patch] ? -use.direction : use.direction;
      sum += std::abs(net);
    }
    return sum;
  };
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    bool better = false;
    for (std::uint32_t patch = 0; patch < p.count; ++patch) {
      if (edges_of[patch].empty()) continue;
      const int before = imbalance(patch);
      over[patch] ^= 1;
      if (imbalance(patch) < before) better = true;
      else over[patch] ^= 1;
    }
    if (!better) break;
  }
  for (std::size_t t = 0; t < p.turn.size(); ++t) p.turn[t] ^= over[p.patch[t]];
}

/// Triangles by component.
std::vector<std::vector<std::uint32_t>> components(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> number = triangle_components(mesh);
  std::vector<std::vector<std::uint32_t>> sets;
  for (std::uint32_t t = 0; t < number.size(); ++t) {
    if (number[t] == sets.size()) sets.emplace_back();
    sets[number[t]].push_back(t);
  }
  return sets;
}

Box box_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Box box;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices_nm[v]);
  }
  return box;
}

/// The winding number of closed triangles around a point.
double winding(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
               const Vec3& p) {
  double sum = 0;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = mesh.vertices_nm[mesh.triangles[t][0]] - p;
    const Vec3 b = mesh.vertices_nm[mesh.triangles[t][1]] - p;
    const Vec3 c = mesh.vertices_nm[mesh.triangles[t][2]] - p;
    sum += half_solid_angle(a, b, c);
  }
  return sum / 6.283185307179586;
}

bool contains(const Box& outer, const Box& inner) {
  Box both = outer;
  both.extend(inner);
  return both.lower_nm == outer.lower_nm && both.upper_nm == outer.upper_nm;
}

std::vector<unsigned char> closed_components(const TriangleMesh& mesh, std::size_t count) {
  const std::vector<std::uint32_t> number = triangle_components(mesh);
  std::vector<unsigned char> closed(count, 1);
  visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
    if (2 * count_forward(mesh.triangles, edge) != edge.uses())
      closed[number[edge.side(0) / 3]] = 0;
  });
  return closed;
}

}  // namespace

std::size_t stitch_rims(TriangleMesh& mesh, double distance_nm) {
  if (!(distance_nm > 0)) return 0;
  std::vector<std::uint32_t> to(mesh.vertices_nm.size());
  for (std::uint32_t v = 0; v < to.size(); ++v) to[v] = v;
  CubeGrid grid(distance_nm);
  std::size_t merged = 0;
  for (const std::uint32_t v : rim_points(mesh)) {
    double least = distance_nm;
    grid.visit_near(mesh.vertices_nm[v], [&](std::uint32_t other) {
      const double d = length(mesh.vertices_nm[v] - mesh.vertices_nm[other]);
      if (d > least || (d == least && to[v] != v)) return;
      least = d;
      to[v] = other;
    });
    if (to[v] == v) grid.add(mesh.vertices_nm[v], v);
    else ++merged;
  }
  for (Triangle& t : mesh.triangles) t = {to[t[0]], to[t[1]], to[t[2]]};
  return merged;
}

std::size_t remove_duplicates(TriangleMesh& mesh) {
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  const Buckets buckets = gather(mesh.vertices_nm.size(), [&](const auto& put) {
    for (std::uint32_t i = 0; i < triangles; ++i) {
      Triangle t = mesh.triangles[i];
      std::ranges::sort(t);
      put(t[0], std::uint64_t{t[1]} << 32 | i);  // groups triangles by their two lowest corners
    }
  });
  std::vector<unsigned char> drop(triangles, 0);
  std::vector<std::uint32_t> balanced;  // one of each group with equally many of both orientations
  const auto is_even = [](Triangle t) {
    const bool odd = (t[0] > t[1]) ^ (t[0] > t[2]) ^ (t[1] > t[2]);
    return !odd;
  };
  const auto settle = [&](const std::vector<std::uint32_t>& copies) {
    const auto even =
        std::ranges::count_if(copies, [&](auto i) { return is_even(mesh.triangles[i]); });
    const auto odd = std::ssize(copies) - even;
    const auto keep = std::ranges::find_if(
        copies, [&](auto i) { return is_even(mesh.triangles[i]) == (even >= odd); });
    for (const std::uint32_t i : copies) drop[i] = i != *keep;
    if (even == odd) balanced.push_back(*keep);
  };
  for (std::size_t p = 0; p < mesh.vertices_nm.size(); ++p) {
    for (std::size_t i = buckets.begin[p]; i < buckets.begin[p + 1];) {
      const std::uint64_t second = buckets.values[i] >> 32;
      std::map<std::uint32_t, std::vector<std::uint32_t>> by_third;
      const std::size_t first = i;
      while (i < buckets.begin[p + 1] && buckets.values[i] >> 32 == second) ++i;
      if (i - first < 2) continue;
      for (std::size_t k = first; k < i; ++k) {
        const auto number = static_cast<std::uint32_t>(buckets.values[k]);
        by_third[std::ranges::max(mesh.triangles[number])].push_back(number);
      }
      for (const auto& group : by_third) {
        if (group.second.size() > 1) settle(group.second);
      }
    }
  }
  if (!balanced.empty()) {
    // Two opposite faces bound nothing, unless they close the surface around them.
    std::vector<unsigned char> lone_sides(triangles, 0);
    visit_edges(mesh.triangles, mesh.vertices_nm.size(), [&](const EdgeUse& edge) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < edge.uses(); ++i) kept += !drop[edge.side(i) / 3];
      if (kept % 2 == 1) return;
      for (std::size_t i = 0; i < edge.uses(); ++i) ++lone_sides[edge.side(i) / 3];
    });
    for (const std::uint32_t i : balanced) drop[i] = lone_sides[i] < 2;
  }
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    if (!drop[i]) mesh.triangles[kept++] = mesh.triangles[i];
  }
  mesh.triangles.resize(kept);
  return triangles - kept;
}

std::size_t orient(TriangleMesh& mesh) {
  Patches p = find_patches(mesh);
  std::vector<double> turned_area(p.count, 0), whole_area(p.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double a = area(mesh, mesh.triangles[t]);
    whole_area[p.patch[t]] += a;
    if (p.turn[t]) turned_area[p.patch[t]] += a;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (turned_area[p.patch[t]] > 0.5 * whole_area[p.patch[t]]) p.turn[t] ^= 1;
  }
  balance_patches(mesh, p);
  std::size_t turned = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!p.turn[t]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++turned;
  }
  return turned;
}

std::size_t turn_outward(TriangleMesh& mesh) {
  const auto sets = components(mesh);
  const std::vector<unsigned char> closed = closed_components(mesh, sets.size());
  std::vector<double> volumes;
  std::vector<Box> boxes;
  for (const auto& set : sets) {
    boxes.push_back(box_of(mesh, set));
    double sum = 0;
    for (const std::uint32_t t : set)
      sum += volume(mesh, mesh.triangles[t], boxes.back().center_nm());
    volumes.push_back(sum);
  }
  std::vector<std::size_t> inside_out;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!closed[i] || volumes[i] >= 0) continue;
    const Vec3 p = mesh.vertices_nm[mesh.triangles[sets[i][0]][0]];
    bool cavity = false;
    for (std::size_t k = 0; k < sets.size() && !cavity; ++k) {
      if (k == i || !closed[k] || !contains(boxes[k], boxes[i])) continue;
      cavity = std::abs(winding(mesh, sets[k], p)) > 0.5;
    }
    if (!cavity) inside_out.push_back(i);
  }
  std::size_t turned = 0;
  for (const std::size_t i : inside_out) {
    for (const std::uint32_t t : sets[i]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    turned += sets[i].size();
  }
  return turned;
}

std::size_t drop_components(TriangleMesh& mesh, double min_diagonal_nm) {
  if (!(min_diagonal_nm > 0)) return 0;
  std::vector<unsigned char> drop(mesh.triangles.size(), 0);
  std::size_t dropped = 0;
  for (const auto& set : components(mesh)) {
    if (length(box_of(mesh, set).size_nm()) >= min_diagonal_nm) continue;
    ++dropped;
    for (const std::uint32_t t : set) drop[t] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < drop.size(); ++t) {
    if (!drop[t]) mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.triangles.resize(kept);
  return dropped;
}

}  // namespace surf
