// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placement.h"

namespace surf {

/// The words for a raster in messages.
struct RasterWords {
  const char* raster;  ///< "A surface"
  const char* value;   ///< "height"
};

/// Checks the invariants of `HeightField` and `PlacedImage`. Throws InvalidInput, naming `subject`.
void validate_raster(const Placement& placement, const Grid<double>& values, const Mask& valid,
                     const RasterWords& words, const char* subject);

}  // namespace surf
