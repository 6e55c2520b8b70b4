// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "reflectance_map.h"
#include "surf/core/grid.h"

namespace surf::bench {

/// One image of an SEM and how its brightness depends on slope.
struct ShadedImage {
  Grid<double> relative;  ///< grey level over that of level ground
  double pitch_nm = 1;    ///< of square pixels
  ReflectanceMap reflectance;
};

/// Called now and then with the heights so far, nm, on the image's pixels.
using HeightsSoFar = std::function<void(const Grid<double>& z_nm)>;

}  // namespace surf::bench
