// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "max_plus.h"

namespace surf::max_plus {

/// The bounding rectangle of the samples of `a` that touch; empty (x0 > x1) if no sample does.
struct Touch {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
};

/// For each place (x, y): the rectangle of all samples with a(x - (i - apex_x), y - (j - apex_y)) +
/// b(i, j) >= least(x, y). `least` is `unknown` where no result is wanted. A higher `least` takes
/// less time.
Grid<Touch> touching(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y,
                     const Grid<Quanta>& least, int threads, const Watch& watch);

}  // namespace surf::max_plus
