// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"

namespace surf {

/// Heights on a regular grid: z up, sample (0, 0) lower-left.
struct HeightField {
  Grid<double> z_nm;          ///< at least 2x2, finite where valid
  Grid<unsigned char> valid;  ///< same size as z_nm, or empty: everything is valid
  double pitch_x_nm = 1;      ///< distance of neighbouring samples, > 0
  double pitch_y_nm = 1;      ///< distance of neighbouring rows, > 0
  double origin_x_nm = 0;     ///< centre of sample (0, 0)
  double origin_y_nm = 0;

  double x_nm(int column) const { return origin_x_nm + column * pitch_x_nm; }
  double y_nm(int row) const { return origin_y_nm + row * pitch_y_nm; }
  bool is_valid(int column, int row) const { return valid.empty() || valid(column, row) != 0; }
};

/// Throws InvalidInput (naming `subject`) if the field is smaller than 2x2, a pitch is not positive
/// and finite, the mask has another size, or a valid height is not finite.
void validate(const HeightField& field, const char* subject = "height field");

}  // namespace surf
