// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/grid.h"
#include "surf/core/placement.h"

namespace surf {

/// The structuring function of an AFM tip, T(x, y) = -tip(-x, -y). A scan is the dilation of the
/// surface by it, I(x) = max over u of S(x - u) + T(u). Its largest value is exactly 0, at the
/// apex; missing samples are -infinity.
struct Tip : Pitch {
  Grid<double> z_nm;  ///< at least 1x1; row-major, sample (0, 0) lower-left; <= 0 or -infinity
  int apex_x = 0;     ///< column of the apex: the sample at u = 0
  int apex_y = 0;     ///< row of the apex
  /// Why the tip is not to be trusted, for people; empty: there is no known reason.
  std::string doubt = {};
};

/// Throws InvalidInput (naming `subject`) if there are no samples, the apex lies outside the grid
/// or is not 0, a sample is above 0 or NaN, or a pitch is not positive and finite.
void validate(const Tip& tip, const char* subject = "tip");

/// The tip reflected at the z axis, (x, y, z) -> (-x, -y, z). It converts between the structuring
/// function and the physical tip's surface, upside down. Reflecting twice gives the same tip.
Tip reflected(const Tip& tip);

}  // namespace surf
