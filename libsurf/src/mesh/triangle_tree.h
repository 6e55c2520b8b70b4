// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/triangle_geometry.h"
#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

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
inline Vec3 closest_point(const Corners& t, const Vec3& p) { return closest_point(t.a, t.b, t.c, p); }

/// A tree of boxes over the triangles of a mesh, which must outlive it unchanged. Building takes
/// O(n log n) and may throw Interrupted; queries may run at once from several threads.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh, const Watch& watch = {});

  /// Calls visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void visit_overlapping(const Box& box, const Visit& visit) const {
    std::uint32_t stack[max_depth];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!overlap(node.box, box)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (overlap(box_of(triangles_[i]), box)) visit(triangles_[i]);
      }
    }
  }

  struct Closest {
    double distance_nm;
    std::uint32_t triangle;
  };
  /// The triangle nearest to `p`; the first one found within 1e-12 of the tree's diagonal will do.
  /// `start` is a guess: any triangle, the nearer the quicker.
  Closest closest(const Vec3& p, std::uint32_t start = 0) const;

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

 private:
  static constexpr int max_depth = 128;
  struct Node {
    Box box;
    std::uint32_t first = 0;   ///< of its triangles, or its two children, which are neighbours
    std::uint32_t count = 0;   ///< of its triangles; 0 in inner nodes
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
             const std::vector<Vec3>& middles, const Watch& watch);

  const TriangleMesh& mesh_;
  double negligible_squared_ = 0;
  std::vector<std::uint32_t> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace surf
