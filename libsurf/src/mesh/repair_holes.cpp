// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/repair_holes.h"

#include <algorithm>
#include <unordered_set>

#include "mesh/boundary.h"
#include "mesh/cgal_fill_hole.h"

namespace surf {
namespace {

double perimeter(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    sum += length(mesh.vertices_nm[loop.points[(i + 1) % loop.points.size()]] -
                  mesh.vertices_nm[loop.points[i]]);
  }
  return sum;
}

/// The diagonal of each triangle's component.
std::vector<double> diagonals(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] == boxes.size()) boxes.emplace_back();
    for (const std::uint32_t v : mesh.triangles[t]) boxes[component[t]].extend(mesh.vertices_nm[v]);
  }
  std::vector<double> result;
  for (const std::uint32_t c : component) result.push_back(length(boxes[c].size_nm()));
  return result;
}

std::uint64_t key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// The existing edges between rim points, so that no fill duplicates an edge or face.
class Occupied {
 public:
  Occupied(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
    std::vector<unsigned char> rim(mesh.vertices_nm.size(), 0);
    for (const BoundaryLoop& loop : loops) {
      for (const std::uint32_t p : loop.points) rim[p] = 1;
    }
    for (Triangle t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (rim[t[k]] && rim[t[(k + 1) % 3]]) edges_.insert(key(t[k], t[(k + 1) % 3]));
      }
    }
  }

  /// Whether a patch over the loop's points has an inner edge that already exists.
  bool meets(const std::vector<Triangle>& patch, const BoundaryLoop& loop) const {
    std::unordered_set<std::uint64_t> own;
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      own.insert(key(loop.points[i], loop.points[(i + 1) % loop.points.size()]));
    }
    return std::ranges::any_of(patch, [&](const Triangle& t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t edge = key(t[k], t[(k + 1) % 3]);
        if (!own.contains(edge) && edges_.contains(edge)) return true;
      }
      return false;
    });
  }

  void add(const std::vector<Triangle>& patch) {
    for (const Triangle& t : patch) {
      for (std::size_t k = 0; k < 3; ++k) edges_.insert(key(t[k], t[(k + 1) % 3]));
    }
  }

 private:
  std::unordered_set<std::uint64_t> edges_;
};

/// Whether the loop is the rim of a single triangle. A fill would only lie on that triangle.
bool is_lone_triangle(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  if (loop.points.size() != 3) return false;
  return loop.sides[0] / 3 == loop.sides[1] / 3 && loop.sides[1] / 3 == loop.sides[2] / 3 &&
         !mesh.triangles.empty();
}

/// The triangles that close a loop. Vertices that they need are added to the mesh.
std::vector<Triangle> patch_for(TriangleMesh& mesh, const BoundaryLoop& loop,
                                const Occupied& occupied, const Watch& watch) {
  if (is_lone_triangle(mesh, loop)) return {};
  const std::vector<std::uint32_t> rim(loop.points.rbegin(), loop.points.rend());
  std::vector<Vec3> corners;
  for (const std::uint32_t p : rim) corners.push_back(mesh.vertices_nm[p]);
  std::vector<Triangle> patch = span_polygon(corners, watch);
  for (Triangle& t : patch) t = {rim[t[0]], rim[t[1]], rim[t[2]]};
  if (!patch.empty() && !occupied.meets(patch, loop)) return patch;
  // A star about the centre has only new edges.
  Vec3 middle;
  for (const Vec3& c : corners) middle += c * (1.0 / static_cast<double>(corners.size()));
  const auto center = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.push_back(middle);
  patch.clear();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    patch.push_back({center, rim[i], rim[(i + 1) % rim.size()]});
  }
  return patch;
}

}  // namespace

std::size_t fill_holes(TriangleMesh& mesh, std::optional<double> max_hole_nm,
                       std::size_t& fill_triangles, const Watch& watch) {
  const std::vector<BoundaryLoop> loops = boundary_loops(mesh.triangles, mesh.vertices_nm.size());
  if (loops.empty()) return 0;
  const std::vector<double> diagonal = diagonals(mesh);
  Occupied occupied(mesh, loops);
  std::size_t filled = 0;
  for (const BoundaryLoop& loop : loops) {
    watch.check();
    if (perimeter(mesh, loop) > max_hole_nm.value_or(diagonal[loop.sides[0] / 3])) continue;
    const std::vector<Triangle> patch = patch_for(mesh, loop, occupied, watch);
    if (patch.empty()) continue;
    occupied.add(patch);
    mesh.triangles.insert(mesh.triangles.end(), patch.begin(), patch.end());
    fill_triangles += patch.size();
    ++filled;
  }
  return filled;
}

std::vector<OpenHole> open_holes(const TriangleMesh& mesh, std::optional<double> max_hole_nm) {
  std::vector<OpenHole> holes;
  const std::vector<BoundaryLoop> loops = boundary_loops(mesh.triangles, mesh.vertices_nm.size());
  if (loops.empty()) return holes;
  const std::vector<double> diagonal = diagonals(mesh);
  for (const BoundaryLoop& loop : loops) {
    const double length_nm = perimeter(mesh, loop);
    holes.push_back({mesh.vertices_nm[loop.points[0]], length_nm, loop.points.size(),
                     length_nm > max_hole_nm.value_or(diagonal[loop.sides[0] / 3])});
  }
  return holes;
}

}  // namespace surf
