// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::mc {

/// A lower bound of the distance to the nearest triangle, for any point.
///
/// Cells that a triangle may touch are marked. The bound of a cell is the gap between its box and
/// the box of the nearest marked cell, so it holds for every point of the cell and every point of
/// the surface. Bounds are kept in a byte, in quarters of a cell, rounded down.
class DistanceGrid {
 public:
  DistanceGrid() = default;

  /// Covers `domain` with at most about `bytes` cells. Triangles may lie anywhere; those outside
  /// the domain are allowed for by treating its sides as surface where something lies beyond.
  DistanceGrid(const TriangleMesh& mesh, const Box& domain, std::size_t bytes);

  double cell_nm() const { return cell_nm_; }
  std::size_t bytes() const { return quarters_.size(); }

  double bound_nm(const Vec3& p) const {
    const double x = (p.x - lower_.x) * cells_per_nm_;
    const double y = (p.y - lower_.y) * cells_per_nm_;
    const double z = (p.z - lower_.z) * cells_per_nm_;
    if (!(x >= 0 && y >= 0 && z >= 0 && x < nx_ && y < ny_ && z < nz_)) return outside_nm(p);
    const std::size_t i = (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
                           static_cast<std::size_t>(y)) * static_cast<std::size_t>(nx_) +
                          static_cast<std::size_t>(x);
    return quarters_[i] * quarter_cell_nm_;
  }

 private:
  double outside_nm(const Vec3& p) const;

  Vec3 lower_;
  double cell_nm_ = 0;
  double cells_per_nm_ = 0;
  double quarter_cell_nm_ = 0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  Box surface_box_;                    // around all triangles
  std::vector<std::uint8_t> quarters_;
};

}  // namespace surf::mc
