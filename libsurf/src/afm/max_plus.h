// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/grid.h"
#include "surf/core/progress.h"

namespace surf::max_plus {

/// Heights as whole numbers of a quantum: known ones in [lowest, 0], so that a sum of two known
/// ones or of two unknown ones fits into 32 bits and is told from the other.
using Quanta = std::int32_t;
inline constexpr Quanta unknown = -(1 << 30);
inline constexpr Quanta lowest = -(1 << 29);  ///< of a known height, and of a sum of two

/// sum(x, y) = max over (i, j) of a(x - (i - apex_x), y - (j - apex_y)) + b(i, j), `unknown` where
/// nothing known contributes; as large as a. Exact: no rounding and no overflow if a known height
/// of a and one of b are together in [lowest, 0].
///
/// With `contact`: the sample i + j * width of b that gives the maximum, -1 where it is unknown. Of
/// several the one of the row nearest the apex, of two the lower one; then of the column nearest
/// the apex, of two the left one.
void convolve(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y, int threads,
              Grid<Quanta>& sum, Grid<std::int32_t>* contact = nullptr, const Watch& watch = {});

}  // namespace surf::max_plus
