// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// The quantisation of an image's values.
struct GreyLevels {
  double quantum = 0;                  ///< step between values; 0: not quantised, or finely
  std::optional<double> black, white;  ///< levels at which more pixels pile up than beside them
};

/// Analyses the pixels that are not 0 in `valid` (same size, or empty); they must be finite. The
/// least or largest of 16 or more levels is a pile if it holds more than ten pixels, and more than
/// three times the mean of the five levels next to it.
GreyLevels grey_levels(const Grid<double>& values, const Mask& valid);

}  // namespace surf
