// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/shared_mesh.h"
#include "surf/core/progress.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// A tree of boxes over those triangles of a mesh that come near a region, for questions about the
/// surface around a point. Answers are conservative: distances are never too large by more than
/// rounding (1e-6 nm up to millimetres from the origin). The mesh must outlive the tree unchanged;
/// questions may be asked from several threads at once.
class FaceTree {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Holds the triangles whose boxes touch `region`. Throws Interrupted.
  FaceTree(const MeshView& mesh, const Box& region, int threads, const Watch& watch = {});

  std::size_t size() const { return faces_.size(); }

  struct Nearest {
    double distance = HUGE_VAL;       ///< or a limit, where `triangle` is none
    std::uint32_t triangle = none;
    Vec3 point;                       ///< on the triangle
  };

  /// Replaces `best` by the nearest triangle that is nearer than it.
  void improve(const Vec3& p, Nearest& best) const;
  /// The same for one triangle: a good guess makes the search short.
  void improve(const Vec3& p, std::uint32_t triangle, Nearest& best) const;

  /// Appends the triangles whose boxes come within `radius` of `p`, in the tree's order.
  void within(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const;

  const MeshView& mesh() const { return mesh_; }

 private:
  struct Node {   // about origin_, rounded outward
    float lower[3];
    float upper[3];
  };
  struct Range {
    std::size_t first, last;
  };
  // The tree is complete: node i has the children 2i + 1 and 2i + 2, and every level shares out the
  // triangles evenly.
  Range range(std::size_t node, int level) const {
    const std::size_t k = node + 1 - (std::size_t{1} << level);
    return {faces_.size() * k >> level, faces_.size() * (k + 1) >> level};
  }
  void corners(std::uint32_t triangle, const Vec3& about, Vec3 (&out)[3]) const;
  void build(int threads, const Watch& watch);
  void bound(std::size_t node, int level);

  struct Entry;
  template <class Reach, class Visit>
  void walk(const Vec3& center, const Reach& reach_squared, const Visit& visit) const;

  const MeshView mesh_;
  Vec3 origin_;
  int levels_ = 0;                      // leaves are at this level
  std::vector<std::uint32_t> faces_;
  std::vector<Node> nodes_;
};

}  // namespace surf::mc
