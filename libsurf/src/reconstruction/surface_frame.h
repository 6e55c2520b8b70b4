// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/core/affine.h"
#include "surf/core/height_field.h"

namespace surf::reconstruction {

/// The samples of the surface: square, row-major.
struct SurfaceFrame {
  int width = 0, height = 0;
  double pitch_nm = 1, origin_x_nm = 0, origin_y_nm = 0;

  Point2 to_samples(Point2 nm) const {
    return {(nm.x - origin_x_nm) / pitch_nm, (nm.y - origin_y_nm) / pitch_nm};
  }
  HeightField field(const Grid<double>& z) const {
    return {{pitch_nm, pitch_nm, origin_x_nm, origin_y_nm}, z};
  }
};

/// A change of the map from the AFM's frame to the surface's samples. It is given by displacements
/// in samples: at the middle of the scan's used part (0 and 3), and the additional displacement at
/// one reach along x (1, 4) and along y (2, 5), and of a drift of the scan that is not steady (6,
/// 7), which bends its rows' places as `drift_share`. So all numbers have the same scale.
inline constexpr int affine_numbers = 6, map_numbers = 8;
using MapChange = std::array<double, map_numbers>;

/// The share of the drift at a row of the scan, `across` reaches from the middle.
inline double drift_share(double across) { return across * across - 1.0 / 3; }

}  // namespace surf::reconstruction
