// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placement.h"

namespace surf {

/// Heights on a regular grid.
struct HeightField : Placement {
  Grid<double> z_nm;  ///< at least 2x2, finite where valid
  Mask valid;         ///< 0: the sample is a hole

  bool is_valid(int column, int row) const { return valid.includes(column, row); }
};

/// Throws InvalidInput (naming `subject`) if the field is smaller than 2x2, its placement is
/// invalid, the mask has another size, or a valid height is not finite or beyond
/// `largest_raster_number`.
void validate(const HeightField& field, const char* subject = "height field");

}  // namespace surf
