// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"
#include "surf/core/grid.h"

namespace surf {

/// One signal with its place in its microscope's frame.
struct PlacedImage {
  Grid<double> values;                      ///< sample (0, 0) lower-left, finite where valid
  Grid<unsigned char> valid;                ///< same size, or empty: everything is valid
  double pitch_x_nm = 1, pitch_y_nm = 1;    ///< > 0
  double origin_x_nm = 0, origin_y_nm = 0;  ///< centre of sample (0, 0)

  bool is_valid(int column, int row) const { return valid.empty() || valid(column, row) != 0; }
  Point2 place_nm(double column, double row) const {
    return {origin_x_nm + column * pitch_x_nm, origin_y_nm + row * pitch_y_nm};
  }
};

/// Throws InvalidInput (naming `subject`) if the image is smaller than 2x2, a pitch is not positive
/// and finite, the mask has another size, or a valid value is not finite.
void validate(const PlacedImage& image, const char* subject = "image");

}  // namespace surf
