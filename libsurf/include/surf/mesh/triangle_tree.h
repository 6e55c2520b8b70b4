// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mesh/mesh_view.h"

namespace surf {

inline bool overlap(const Box& a, const Box& b) {
  return a.lower_nm.x <= b.upper_nm.x && b.lower_nm.x <= a.upper_nm.x &&
         a.lower_nm.y <= b.upper_nm.y && b.lower_nm.y <= a.upper_nm.y &&
         a.lower_nm.z <= b.upper_nm.z && b.lower_nm.z <= a.upper_nm.z;
}

/// The corners of a triangle.
struct Corners {
  Vec3 a, b, c;
};

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
inline Vec3 closest_point(const Corners& t, const Vec3& p) {
  return closest_point(t.a, t.b, t.c, p);
}

/// A bounding-volume hierarchy over the triangles of a mesh, or over those near a region. The mesh
/// must outlive the tree and must not change. Building takes O(n log n), and the result does not
/// depend on the number of threads. Several threads may make queries at once.
///
/// The tree is complete, so it needs no pointers: node i has the children 2i + 1 and 2i + 2, and
/// each level divides the triangles evenly. Boxes are stored in single precision, rounded outward.
class TriangleTree {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// A tree of all triangles. `threads` >= 0; 0: one per hardware thread. Throws Interrupted.
  explicit TriangleTree(const MeshView& mesh, const Watch& watch = {}, int threads = 1);
  /// A tree of the triangles whose boxes touch `region`.
  TriangleTree(const MeshView& mesh, const Box& region, const Watch& watch = {}, int threads = 1);

  std::size_t size() const { return faces_.size(); }
  const MeshView& mesh() const { return mesh_; }

  Corners corners(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {mesh_.vertices_nm[t[0]], mesh_.vertices_nm[t[1]], mesh_.vertices_nm[t[2]]};
  }
  Box box_of(std::uint32_t triangle) const {
    const Corners t = corners(triangle);
    Box box;
    box.extend(t.a);
    box.extend(t.b);
    box.extend(t.c);
    return box;
  }

  /// Calls visit(triangle) for all triangles whose boxes are closer to `center` than the root of
  /// `reach_squared()`, and possibly for others. Nearer triangles come first if boxes do not
  /// overlap. The reach may shrink during the traversal.
  template <class Reach, class Visit>
  void visit_near(const Vec3& center, const Reach& reach_squared, const Visit& visit) const;

  /// Calls visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void visit_overlapping(const Box& box, const Visit& visit) const;

  struct Closest {
    double distance_nm;
    std::uint32_t triangle;
  };
  /// The triangle nearest to `p`. A triangle within 1e-12 of the tree's diagonal ends the search.
  /// `start` is a guess: any triangle is allowed, and a near one makes the search faster.
  Closest closest(const Vec3& p, std::uint32_t start = 0) const;

 private:
  static constexpr double rounding = 1e-9;  // relative, of squared distances
  static constexpr std::size_t most_on_stack = 80;

  struct Node {  // relative to origin_, rounded outward
    float lower[3];
    float upper[3];
  };
  struct Range {
    std::size_t first, last;
  };
  struct Place {
    std::size_t node;
    int level;
  };
  struct NearPlace : Place {
    double squared;  // distance of the node's box
  };

  Range range(const Place& p) const {
    const std::size_t k = p.node + 1 - (std::size_t{1} << p.level);
    return {faces_.size() * k >> p.level, faces_.size() * (k + 1) >> p.level};
  }
  void build(const Watch& watch, int threads);
  void bound(const Place& place);

  const MeshView mesh_;
  Vec3 origin_;
  double negligible_squared_ = 0;
  int levels_ = 0;  // leaves are at this level
  std::vector<std::uint32_t> faces_;
  std::vector<Node> nodes_;
};

template <class Reach, class Visit>
void TriangleTree::visit_near(const Vec3& center, const Reach& reach_squared,
                              const Visit& visit) const {
  if (faces_.empty()) return;
  const Vec3 c = center - origin_;
  std::array<NearPlace, most_on_stack> stack;
  std::size_t size = 0;
  const auto found = [&](std::size_t node, int level, NearPlace& e) {
    const Node& b = nodes_[node];
    const Vec3 lower = Vec3{b.lower[0], b.lower[1], b.lower[2]} - c;
    const Vec3 upper = Vec3{b.upper[0], b.upper[1], b.upper[2]} - c;
    const double x = std::max(std::max(0.0, lower.x), -upper.x);
    const double y = std::max(std::max(0.0, lower.y), -upper.y);
    const double z = std::max(std::max(0.0, lower.z), -upper.z);
    e = {{node, level}, (x * x + y * y + z * z) * (1 - rounding)};
    return e.squared < reach_squared();
  };
  size += found(0, 0, stack[0]) ? 1 : 0;
  while (size > 0) {
    const NearPlace e = stack[--size];
    if (!(e.squared < reach_squared())) continue;
    if (e.level == levels_) {
      const Range r = range(e);
      for (std::size_t i = r.first; i < r.last; ++i) visit(faces_[i]);
      continue;
    }
    const std::size_t before = size;
    size += found(2 * e.node + 1, e.level + 1, stack[size]) ? 1 : 0;
    size += found(2 * e.node + 2, e.level + 1, stack[size]) ? 1 : 0;
    if (size == before + 2 && stack[size - 2].squared < stack[size - 1].squared)
      std::swap(stack[size - 2], stack[size - 1]);
  }
}

template <class Visit>
void TriangleTree::visit_overlapping(const Box& box, const Visit& visit) const {
  if (faces_.empty() || box.empty()) return;
  const Vec3 lower = box.lower_nm - origin_, upper = box.upper_nm - origin_;
  std::array<Place, most_on_stack> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Place e = stack[--size];
    const Node& b = nodes_[e.node];
    if (b.lower[0] > upper.x || b.lower[1] > upper.y || b.lower[2] > upper.z ||
        b.upper[0] < lower.x || b.upper[1] < lower.y || b.upper[2] < lower.z)
      continue;
    if (e.level != levels_) {
      stack[size++] = {2 * e.node + 1, e.level + 1};
      stack[size++] = {2 * e.node + 2, e.level + 1};
      continue;
    }
    const Range r = range(e);
    for (std::size_t i = r.first; i < r.last; ++i)
      if (overlap(box_of(faces_[i]), box)) visit(faces_[i]);
  }
}

}  // namespace surf
