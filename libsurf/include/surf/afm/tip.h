// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/core/grid.h"
#include "surf/core/placement.h"

namespace surf {

/// The structuring function of an AFM tip, T(x, y) = -tip(-x, -y): a scan is the dilation of the
/// surface by it, I(x) = max over u of S(x - u) + T(u). Its largest value is exactly 0, at the
/// apex; samples that the tip does not have are -infinity.
struct Tip : Pitch {
  Grid<double> z_nm;  ///< at least 1x1; row-major, sample (0, 0) lower-left; <= 0 or -infinity
  int apex_x = 0;     ///< column of the apex: the sample at u = 0
  int apex_y = 0;     ///< row of the apex
  std::string doubt =
      {};  ///< why the tip is not to be trusted, for people; empty: nothing is known against it
};

/// Throws InvalidInput (naming `subject`) if there are no samples, the apex lies outside or is not
/// 0, a sample is above 0 or NaN, or a pitch is not positive and finite.
void validate(const Tip& tip, const char* subject = "tip");

/// The same seen from the other side, (x, y, z) -> (-x, -y, z): the physical tip's surface, upside
/// down, becomes the structuring function and the other way round. Twice gives the same tip.
Tip reflected(const Tip& tip);

}  // namespace surf
