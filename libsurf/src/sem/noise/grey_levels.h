// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// How an image's values were stored.
struct GreyLevels {
  double quantum = 0;  ///< all values are whole multiples of it apart; 0: of nothing coarse
  std::optional<double> black, white;  ///< levels at which more pixels pile up than beside them
};

/// Of the pixels that are not 0 in `valid` (same size, or empty), which are finite. A level is a
/// pile if it is the least or largest of 16 or more, and holds more than three times the mean of
/// the five levels next to it and ten pixels.
GreyLevels grey_levels(const Grid<double>& values, const Mask& valid);

}  // namespace surf
