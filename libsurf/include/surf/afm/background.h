// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// A plane z = height + slope_x (x - x_c) + slope_y (y - y_c) about the centre of a field.
struct Plane {
  double height_nm = 0;
  double slope_x = 0;  ///< nm per nm
  double slope_y = 0;
  double centre_x_nm = 0;
  double centre_y_nm = 0;

  double at(double x_nm, double y_nm) const {
    return height_nm + slope_x * (x_nm - centre_x_nm) + slope_y * (y_nm - centre_y_nm);
  }
  double tilt_deg() const;  ///< from the horizontal, 0 to 90
  double uphill_deg()
      const;  ///< direction in which it rises most, counter-clockwise from +x; 0 to 360
};

/// The plane of least squares of the vertical distances. Samples that are 0 in `use` (same size, or
/// empty: all count) and holes play no part.
/// Throws InvalidInput if what is left is fewer than three samples or lies on one line.
Plane fit_plane(const HeightField& field, const Mask& use = {});

/// The same with a polynomial of all terms x^i y^j, i + j <= degree (0 to 6), evaluated at every
/// sample, holes too. Far from the samples used it means little. Throws InvalidInput if the samples
/// do not determine it, UsageError for another degree.
Grid<double> fit_polynomial(const HeightField& field, int degree, const Mask& use = {});

/// Takes it off the heights; holes stay as they are.
void subtract(HeightField& field, const Plane& plane);
void subtract(HeightField& field, const Grid<double>& background);

}  // namespace surf
