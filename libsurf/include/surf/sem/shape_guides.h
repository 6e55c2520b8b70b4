// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/progress.h"
#include "surf/sem/guided_estimate.h"

namespace surf {

/// The surface that each pixel's beam meets first.
struct SeenSurface {
  double pixel_x_nm = 1, pixel_y_nm = 1;  ///< > 0
  Grid<double> height_nm;                 ///< against the beam, from any plane across it
  Grid<double> cosine;                    ///< of the angle between normal and beam, -1 to 1
  Grid<std::uint8_t> seen;                ///< 0: the beam meets nothing there
  double spot_nm = 0;  ///< standard deviation of the beam's spot: guides are blurred as it blurs
};

/// Guides that shape gives: the path under a tilted surface (1 / cosine), the height above means
/// over three distances, the share of the sky that is free, and how near steps are, from above and
/// from below. Distances are those that secondary electrons, and backscattered ones of a few keV,
/// take in matter (3, 8 and 20 nm), and no less than 1.5, 4 and 10 pixels. All are 0 where
/// nothing is seen. Results do not depend on threads. Throws InvalidInput for sizes that differ,
/// Interrupted.
std::vector<Guide> shape_guides(const SeenSurface& surface, int threads = 0,
                                const Watch& watch = {});

}  // namespace surf
