// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A sample's column and row.
struct LatticePoint {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

/// Twice the signed area; > 0 if a, b, c run counter-clockwise. Exact.
inline std::int64_t doubled_area(LatticePoint a, LatticePoint b, LatticePoint c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
         (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

/// An incremental Delaunay triangulation of integer points that fills a rectangle. All predicates
/// are exact; coordinates are below 2^30. Side 3 t + k runs from corner k of triangle t to the next
/// corner. If four points lie on a circle, the order of insertion decides which diagonal they have.
class LatticeDelaunay {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Starts with the rectangle from (0, 0) to (columns - 1, rows - 1) in two triangles; at least
  /// 2 x 2.
  LatticeDelaunay(std::int32_t columns, std::int32_t rows);

  const std::vector<LatticePoint>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  LatticePoint corner(std::uint32_t triangle, std::size_t k) const {
    return points_[triangles_[triangle][k]];
  }
  /// The opposite side, in the neighbouring triangle; `none` at the rim.
  std::uint32_t opposite(std::uint32_t side) const { return opposite_[side]; }

  /// A triangle that contains `p`, found by a walk from `start`.
  std::uint32_t find(LatticePoint p, std::uint32_t start) const;

  /// Inserts a point that lies in a triangle, inside or on a side, and is none of its corners.
  /// Appends to `changed` every triangle that is new or has other corners than before, some of them
  /// twice.
  void insert(LatticePoint p, std::uint32_t triangle, std::vector<std::uint32_t>& changed);

  /// Sets the diagonal of unit cells whose four corners are points: from lower-left to upper-right.
  void prefer_rising_diagonals();

 private:
  void set(std::uint32_t triangle, Triangle corners, std::uint32_t first, std::uint32_t second,
           std::uint32_t third);
  std::uint32_t add();
  void restore(std::vector<std::uint32_t>& suspects, std::vector<std::uint32_t>& changed);
  bool breaks_delaunay(std::uint32_t side) const;
  void flip(std::uint32_t side);

  std::vector<LatticePoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> opposite_;  // of every side
};

}  // namespace surf
