// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "mesh/repair_steps.h"

namespace surf {
namespace {

constexpr int max_passes = 16;  // a pass may expose the next sliver of a chain
constexpr double relative_area = 4 * std::numeric_limits<double>::epsilon();  // as check_mesh

/// The shape of a triangle: the corner opposite to its longest side, and its height over that side.
struct Shape {
  std::size_t apex;
  double height_nm;
  double shortest_nm;
  bool flat;  ///< no area within rounding
};

Shape shape(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 v[] = {mesh.vertices_nm[t[0]], mesh.vertices_nm[t[1]], mesh.vertices_nm[t[2]]};
  double side[3];
  for (std::size_t k = 0; k < 3; ++k) side[k] = length(v[(k + 2) % 3] - v[(k + 1) % 3]);
  const auto apex = static_cast<std::size_t>(std::max_element(side, side + 3) - side);
  const double twice_area = length(cross(v[1] - v[0], v[2] - v[0]));
  return {apex, side[apex] > 0 ? twice_area / side[apex] : 0, *std::min_element(side, side + 3),
          twice_area <= relative_area * side[1] * side[2]};
}

/// A mesh with the triangles of every vertex, which stay up to date while triangles change.
class Editor {
 public:
  Editor(TriangleMesh& mesh, double sliver_nm)
      : mesh_(mesh), sliver_nm_(sliver_nm), gone_(mesh.triangles.size(), 0),
        around_(mesh.vertices_nm.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) around_[v].push_back(t);
    }
  }

  bool is_bad(std::uint32_t t) const {
    if (gone_[t]) return false;
    if (has_repeated_corner(mesh_.triangles[t])) return true;
    const Shape s = shape(mesh_, mesh_.triangles[t]);
    return s.flat || s.height_nm < sliver_nm_;
  }

  /// Tries to remove a bad triangle.
  bool remove(std::uint32_t t) {
    if (has_repeated_corner(mesh_.triangles[t])) return drop(t);
    const Shape s = shape(mesh_, mesh_.triangles[t]);
    if (s.shortest_nm < sliver_nm_ && collapse_shortest(t)) return true;
    const auto& corners = mesh_.triangles[t];
    const std::uint32_t apex = corners[s.apex];
    const std::uint32_t from = corners[(s.apex + 1) % 3];
    const std::uint32_t to = corners[(s.apex + 2) % 3];
    const std::vector<std::uint32_t> sharing = at_edge(from, to);
    if (sharing.size() == 1) return drop(t);
    if (sharing.size() > 2) return false;
    return flip(t, sharing[0] == t ? sharing[1] : sharing[0], apex, from, to);
  }

  void finish() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < gone_.size(); ++t) {
      if (!gone_[t]) mesh_.triangles[kept++] = mesh_.triangles[t];
    }
    mesh_.triangles.resize(kept);
  }

 private:
  bool drop(std::uint32_t t) {
    for (const std::uint32_t v : mesh_.triangles[t]) std::erase(around_[v], t);
    gone_[t] = 1;
    return true;
  }

  std::vector<std::uint32_t> at_edge(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around_[a]) {
      if (std::ranges::count(mesh_.triangles[t], b) > 0) found.push_back(t);
    }
    return found;
  }

  void replace(std::uint32_t t, const Triangle& corners) {
    for (const std::uint32_t v : mesh_.triangles[t]) std::erase(around_[v], t);
    mesh_.triangles[t] = corners;
    for (const std::uint32_t v : corners) around_[v].push_back(t);
  }

  /// Replaces the bad triangle (apex, from, to) and its neighbour across the longest side by the
  /// two triangles with the other diagonal.
  bool flip(std::uint32_t t, std::uint32_t neighbour, std::uint32_t apex, std::uint32_t from,
            std::uint32_t to) {
    const Triangle n = mesh_.triangles[neighbour];
    if (has_repeated_corner(n)) return false;
    std::uint32_t far = apex;
    for (const std::uint32_t v : n) {
      if (v != from && v != to) far = v;
    }
    if (far == apex || !at_edge(apex, far).empty()) return false;
    // Replacing one end of the shared side keeps the orientation of the neighbour.
    const auto with = [&](std::uint32_t old) {
      Triangle corners = n;
      std::ranges::replace(corners, old, apex);
      return corners;
    };
    const Triangle first = with(from);
    const Triangle second = with(to);
    const auto worse = [&](const Triangle& c) {
      return shape(mesh_, c).flat && !shape(mesh_, n).flat;
    };
    if (worse(first) || worse(second)) return false;
    replace(t, first);
    replace(neighbour, second);
    return true;
  }

  std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around_[v]) {
      for (const std::uint32_t other : mesh_.triangles[t]) {
        if (other != v) found.push_back(other);
      }
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  bool collapse_shortest(std::uint32_t t) {
    const Triangle c = mesh_.triangles[t];
    std::size_t k = 0;
    const auto side = [&](std::size_t i) {
      return length(mesh_.vertices_nm[c[(i + 1) % 3]] - mesh_.vertices_nm[c[i]]);
    };
    for (std::size_t i = 1; i < 3; ++i) {
      if (side(i) < side(k)) k = i;
    }
    const std::uint32_t keep = std::min(c[k], c[(k + 1) % 3]);
    const std::uint32_t gone = std::max(c[k], c[(k + 1) % 3]);
    // The link condition: the ends may have no common neighbours other than the third corners of
    // their shared triangles.
    const std::vector<std::uint32_t> a = neighbours(keep), b = neighbours(gone);
    std::vector<std::uint32_t> common;
    std::ranges::set_intersection(a, b, std::back_inserter(common));
    const std::vector<std::uint32_t> sharing = at_edge(keep, gone);
    if (common.size() != sharing.size()) return false;
    for (const std::uint32_t s : sharing) drop(s);
    const std::vector<std::uint32_t> moved = around_[gone];
    for (const std::uint32_t m : moved) {
      Triangle corners = mesh_.triangles[m];
      std::ranges::replace(corners, gone, keep);
      replace(m, corners);
    }
    return true;
  }

  TriangleMesh& mesh_;
  const double sliver_nm_;
  std::vector<unsigned char> gone_;
  std::vector<std::vector<std::uint32_t>> around_;
};

bool any_bad(const TriangleMesh& mesh, double sliver_nm) {
  return std::ranges::any_of(mesh.triangles, [&](const Triangle& t) {
    if (has_repeated_corner(t)) return true;
    const Shape s = shape(mesh, t);
    return s.flat || s.height_nm < sliver_nm;
  });
}

}  // namespace

std::size_t remove_degenerate(TriangleMesh& mesh, double sliver_nm) {
  if (!any_bad(mesh, sliver_nm)) return 0;
  Editor editor(mesh, sliver_nm);
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  std::size_t removed = 0;
  for (int pass = 0; pass < max_passes; ++pass) {
    const std::size_t before = removed;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      if (editor.is_bad(t) && editor.remove(t)) ++removed;
    }
    if (removed == before) break;
  }
  editor.finish();
  return removed;
}

}  // namespace surf
