// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::mc {

/// A proven lower bound of the distance from any point to the nearest triangle, tight where the
/// surface is nearly flat.
///
/// Space is cut into bricks, and bricks near surfaces that are not flat into 4 x 4 x 4 cells. Each
/// brick or cell knows a slab: all surface within a ball around its centre c lies between the planes
/// n.(x - c) = low and high. The ball has the radius d + 2 r, where d is the distance of c from the
/// surface and r the distance of the brick's or cell's corners from c; a smaller one would limit the
/// bound, a larger one would only make the slab thicker. At a point p of the cell the bound is
///   max(d - r, min(gap between p and the slab, d + r)).
/// All numbers are kept in 16 bits, rounded so that the bound stays one.
class NearField {
 public:
  NearField() = default;

  /// Covers `domain` and a little around it with about `bytes` of memory (>= 0; 0: only points
  /// outside the box of all triangles get a bound). Triangles may lie anywhere.
  /// `threads` >= 0; 0: one per hardware thread. The result does not depend on it.
  NearField(const TriangleMesh& mesh, const Box& domain, std::size_t bytes, int threads = 0);

  double cell_nm() const { return cell_nm_; }   ///< the smallest cells; 0 without any
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
    float fx = static_cast<float>(x - bx), fy = static_cast<float>(y - by);
    float fz = static_cast<float>(z - bz);
    if (!(brick & is_cut)) return bound(cells_[brick], fx, fy, fz, brick_scale_, brick_unit_nm_);
    fx *= cut;
    fy *= cut;
    fz *= cut;
    // A point a rounding error short of the next brick may come out as in it.
    const int cx = std::min(static_cast<int>(fx), cut - 1);
    const int cy = std::min(static_cast<int>(fy), cut - 1);
    const int cz = std::min(static_cast<int>(fz), cut - 1);
    const Cell& cell = cells_[(brick & ~is_cut) + static_cast<std::uint32_t>((cz * cut + cy) * cut + cx)];
    return bound(cell, fx - static_cast<float>(cx), fy - static_cast<float>(cy),
                 fz - static_cast<float>(cz), cell_scale_, cell_unit_nm_);
  }

 private:
  friend class NearFieldBuilder;
  static constexpr int cut = 4;                          // cells along a brick
  static constexpr std::uint32_t is_cut = 0x80000000u;   // of a brick's number of its first cell

  // Lengths in units of the level, `n` in 1/32767.
  struct Cell {
    std::array<std::int16_t, 3> n;
    std::int16_t low, high;
    std::uint16_t reach;   // d + r
    std::uint16_t floor;   // d - r
    std::uint16_t spare;
  };

  // `x` etc. are within the cell, 0 to 1.
  static double bound(const Cell& cell, float x, float y, float z, float scale, float unit_nm) {
    const float t = scale * (static_cast<float>(cell.n[0]) * (x - 0.5f) +
                             static_cast<float>(cell.n[1]) * (y - 0.5f) +
                             static_cast<float>(cell.n[2]) * (z - 0.5f));
    const float gap = std::max(t - static_cast<float>(cell.high), static_cast<float>(cell.low) - t);
    const float b = std::max(std::min(gap, static_cast<float>(cell.reach)),
                             static_cast<float>(cell.floor));
    return static_cast<double>(b * unit_nm);
  }

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
            static_cast<std::size_t>(y)) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(x);
  }
  double outside_nm(const Vec3& p) const;

  Vec3 lower_;
  double bricks_per_nm_ = 0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  float brick_scale_ = 0, cell_scale_ = 0;         // from n.x in cells to units
  float brick_unit_nm_ = 0, cell_unit_nm_ = 0;
  double cell_nm_ = 0;
  Box surface_box_;                                // around all triangles
  std::vector<std::uint32_t> bricks_;
  std::vector<Cell> cells_;
};

}  // namespace surf::mc
