// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mesh/mesh_view.h"

namespace surf::mc {

/// Whether a ray that rises meets nothing any more, where that is cheap to prove.
///
/// The plane below is cut into square columns. Every column knows, for 8 directions and for rings
/// about it that double in radius, the height of the highest surface in that part of the ring. A
/// ray is free where it is above every one of them in its direction when it enters the ring. It may
/// start on the surface itself: where that is a plateau, at the height of the highest surface
/// around it; or on a slope, where all surface around faces upward and the ray rises more steeply.
class HorizonMap {
 public:
  HorizonMap() = default;

  /// Columns over `domain`, at most about `columns` of them (>= 0; 0: only what is above everything
  /// is free). Triangles may lie anywhere. Throws Interrupted.
  HorizonMap(const MeshView& mesh, const Box& domain, std::size_t columns, int threads = 0,
             const Watch& watch = {});

  std::size_t bytes() const {
    return around_.size() * sizeof(double) + (heights_.size() + slopes_.size()) * sizeof(float);
  }

  /// True only where the ray from `p` along the unit vector `direction` meets no triangle. `p` lies
  /// in vacuum or on the surface, and the triangles' normals point out of matter.
  bool is_free(const Vec3& p, const Vec3& direction) const {
    if (!(direction.z > 0)) return false;
    if (p.z >= top_nm_) return true;
    const double x = (p.x - lower_x_) * columns_per_nm_, y = (p.y - lower_y_) * columns_per_nm_;
    if (!(x >= 0 && y >= 0 && x < nx_ && y < ny_)) return false;
    const std::size_t column =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x);
    const double across = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    if (!(p.z >= around_[column]) && !(direction.z > static_cast<double>(slopes_[column]) * across))
      return false;
    const float* const ring = &heights_[(column * sectors + sector(direction)) * rings];
    // How far it rises until the first ring, one column away; 1e-9 for rounding, and for rays
    // straight up.
    double rise = direction.z * (1 - 1e-9) / (across * columns_per_nm_ + 1e-9);
    for (std::size_t i = 0; i < rings; ++i, rise *= 2)
      if (!(p.z + rise > static_cast<double>(ring[i]))) return false;
    return true;
  }

 private:
  friend class HorizonMapBuilder;
  static constexpr std::size_t sectors = 8, rings = 11;

  // Sector k holds the azimuths from k to k + 1 eighths of a turn.
  static std::size_t sector(const Vec3& d) {
    const std::size_t quarter = d.y >= 0 ? (d.x >= 0 ? 0u : 1u) : (d.x < 0 ? 2u : 3u);
    const bool steep = std::fabs(d.y) > std::fabs(d.x);
    return 2 * quarter + (steep != (quarter % 2 == 1) ? 1u : 0u);
  }

  double lower_x_ = 0, lower_y_ = 0;
  double columns_per_nm_ = 0;
  int nx_ = 0, ny_ = 0;
  double top_nm_ = -HUGE_VAL;   // of all triangles
  std::vector<double> around_;  // of the surface in the column and its neighbours, exactly
  std::vector<float>
      slopes_;  // the steepest there; infinite where some surface faces down or aside
  std::vector<float> heights_;  // column, sector, ring; rounded up
};

}  // namespace surf::mc
