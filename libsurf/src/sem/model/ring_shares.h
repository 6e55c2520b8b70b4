// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace surf {

/// A point that represents an equal share of a ring's area.
struct RingPoint {
  int dx, dy;           // the pixel that contains it, relative to the centre
  double cosine, sine;  // direction from the centre
};

/// Points distributed over ring `k`, radii k ring_nm to (k + 1) ring_nm. They are the same in each
/// octant, mirrored, so that sums over them have the symmetry of the square pixels of `pixel_nm`.
std::vector<RingPoint> ring_points(int k, double ring_nm, double pixel_nm);

/// The number of pixels to each side that `rings` rings extend over.
int ring_reach(int rings, double ring_nm, double pixel_nm);

}  // namespace surf
