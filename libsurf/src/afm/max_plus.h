// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/grid.h"
#include "surf/core/progress.h"

namespace surf::max_plus {

/// Heights as whole numbers of a quantum. Known heights are in [lowest, 0]. A sum of two known or
/// of two unknown heights then fits into 32 bits, and the two cases can be told apart.
using Quanta = std::int32_t;
inline constexpr Quanta unknown = -(1 << 30);
/// The lowest known height, and the lowest sum of two.
inline constexpr Quanta lowest = -(1 << 29);

/// sum(x, y) = max over (i, j) of a(x - (i - apex_x), y - (j - apex_y)) + b(i, j). `unknown` where
/// no known height contributes. The result has the size of a. It is exact, without rounding and
/// overflow, if every sum of known heights of a and b is in [lowest, 0].
///
/// `contact`, if given, is set to the sample i + j * width of b that gives the maximum, -1 where
/// the maximum is unknown. Among several samples, the row nearest the apex counts (of two the lower
/// one), then the column nearest the apex (of two the left one).
void convolve(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y, int threads,
              Grid<Quanta>& sum, Grid<std::int32_t>* contact = nullptr, const Watch& watch = {});

}  // namespace surf::max_plus
