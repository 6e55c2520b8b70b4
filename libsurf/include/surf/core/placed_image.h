// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placement.h"

namespace surf {

/// One signal, placed in the frame of its microscope.
struct PlacedImage : Placement {
  Grid<double> values;  ///< at least 2x2, finite where valid
  Mask valid;           ///< pixels with a signal

  bool is_valid(int column, int row) const { return valid.includes(column, row); }
};

/// Throws InvalidInput (naming `subject`) if the image is smaller than 2x2, its placement is
/// invalid, the mask has another size, or a valid value is not finite.
void validate(const PlacedImage& image, const char* subject = "image");

}  // namespace surf
