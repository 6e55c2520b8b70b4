// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mesh/mesh_view.h"

namespace surf::mc {

/// A proven lower bound of the distance from any point to the nearest triangle, tight where the
/// surface is nearly flat.
///
/// Space is cut into bricks, and bricks near surfaces that are not flat into 4 x 4 x 4 cells. Each
/// brick or cell knows a slab: all surface within a ball around its centre c lies between the
/// planes n.(x - c) = low and high. The ball has the radius d + 2 r, where d is the distance of c
/// from the surface and r the distance of the brick's or cell's corners from c; a smaller one would
/// limit the bound, a larger one would only make the slab thicker. At a point p of the cell the
/// bound is
///   max(0, d - r, min(gap between p and the slab, d + r)).
/// All numbers are kept in 16 bits, rounded so that the bound stays one.
class DistanceGrid {
 public:
  DistanceGrid() = default;

  /// Covers `domain` and a little around it with about `bytes` of memory (>= 0; 0: only points
  /// outside the box of all triangles get a bound). Triangles may lie anywhere.
  /// `threads` >= 0; 0: one per hardware thread. The result does not depend on it.
  /// Throws Interrupted.
  DistanceGrid(const MeshView& mesh, const Box& domain, std::size_t bytes, int threads = 0,
               const Watch& watch = {});

  double cell_nm() const { return cell_nm_; }  ///< the smallest cells; 0 without any
  std::size_t bytes() const {
    return bricks_.size() * sizeof(std::uint32_t) + cells_.size() * sizeof(Cell);
  }

  double bound_nm(const Vec3& p) const {
    const double x = (p.x - lower_.x) * bricks_per_nm_;
    const double y = (p.y - lower_.y) * bricks_per_nm_;
    const double z = (p.z - lower_.z) * bricks_per_nm_;
    if (!(x >= 0 && y >= 0 && z >= 0 && x < nx_ && y < ny_ && z < nz_)) return outside_nm(p);
    const int bx = static_cast<int>(x), by = static_cast<int>(y), bz = static_cast<int>(z);
    const std::uint32_t brick = bricks_[index(bx, by, bz)];
    const Level& level = levels_[brick >> 31];
    const float fx = static_cast<float>(x - bx) * level.cells;
    const float fy = static_cast<float>(y - by) * level.cells;
    const float fz = static_cast<float>(z - bz) * level.cells;
    // A point a rounding error short of the next brick may come out as in it.
    const int cx = std::min(static_cast<int>(fx), level.last);
    const int cy = std::min(static_cast<int>(fy), level.last);
    const int cz = std::min(static_cast<int>(fz), level.last);
    const Cell& cell =
        cells_[(brick & ~is_cut) + static_cast<std::uint32_t>((cz * cut + cy) * cut + cx)];
    return bound(cell, fx - static_cast<float>(cx), fy - static_cast<float>(cy),
                 fz - static_cast<float>(cz), level);
  }

 private:
  friend class DistanceGridBuilder;
  static constexpr int cut = 4;                         // cells along a brick
  static constexpr std::uint32_t is_cut = 0x80000000u;  // of a brick's number of its first cell

  // Lengths in units of the level, `n` in 1/32767.
  struct Cell {
    std::array<std::int16_t, 3> n;
    std::int16_t low, high;
    std::uint16_t distance;  // d
  };

  // Whole bricks, and cells.
  struct Level {
    float cells = 1;  // along a brick
    int last = 0;     // of them
    float scale = 0;  // from n.x in cells to units
    float unit_nm = 0;
    float beyond = 0;  // r, rounded down
    float inside = 0;  // r, rounded up
  };

  // `x` etc. are within the cell, 0 to 1.
  static double bound(const Cell& cell, float x, float y, float z, const Level& level) {
    const float t = level.scale * (static_cast<float>(cell.n[0]) * (x - 0.5f) +
                                   static_cast<float>(cell.n[1]) * (y - 0.5f) +
                                   static_cast<float>(cell.n[2]) * (z - 0.5f));
    const float d = static_cast<float>(cell.distance);
    const float gap = std::max(t - static_cast<float>(cell.high), static_cast<float>(cell.low) - t);
    const float b = std::max(std::min(gap, d + level.beyond), std::max(d - level.inside, 0.0f));
    return static_cast<double>(b * level.unit_nm);
  }

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(x);
  }
  double outside_nm(const Vec3& p) const;

  Vec3 lower_;
  double bricks_per_nm_ = 0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  std::array<Level, 2> levels_;
  double cell_nm_ = 0;
  Box surface_box_;  // around all triangles
  std::vector<std::uint32_t> bricks_;
  std::vector<Cell> cells_;
};

}  // namespace surf::mc
