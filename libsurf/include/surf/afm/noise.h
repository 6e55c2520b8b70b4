// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"

namespace surf {

/// Noise of an AFM image along its scan lines, e(t) = alpha e(t - 1) + v(t) with independent normal v
/// (thesis, 8.1.1). Each scan line, a row from left to right, begins with a new draw from the stationary
/// distribution, of variance innovation / (1 - alpha^2).
struct AfmNoise {
  double alpha = 0;                    ///< in (-1, 1); 0: white
  double innovation_nm2 = 1;           ///< variance of v, > 0
  double variance_nm2() const { return innovation_nm2 / (1 - alpha * alpha); }
};

}  // namespace surf
