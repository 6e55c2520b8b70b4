// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace surf {

/// A point that stands for an equal share of a ring's area.
struct RingPoint {
  int dx, dy;           // the pixel that it lies in, from the one at the rings' centre
  double cosine, sine;  // its direction from the centre
};

/// Points spread over ring `k`, radii k ring_nm to (k + 1) ring_nm: the same in each octant,
/// mirrored, so that whatever is summed over them has the symmetry of the square pixels of
/// `pixel_nm`.
std::vector<RingPoint> ring_points(int k, double ring_nm, double pixel_nm);

/// Pixels to each side that `rings` rings reach into.
int ring_reach(int rings, double ring_nm, double pixel_nm);

}  // namespace surf
