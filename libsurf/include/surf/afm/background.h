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
  /// Direction of steepest ascent, counter-clockwise from +x, 0 to 360.
  double uphill_deg() const;
};

/// The plane that minimises the squared vertical distances. Holes and samples that are 0 in `use`
/// do not count (`use` has the field's size, or is empty: all count). Throws InvalidInput if fewer
/// than three samples are left or they all lie on one line.
Plane fit_plane(const HeightField& field, const Mask& use = {});

/// Standard errors of the slopes of `fit_plane`, nm per nm.
struct SlopeDoubt {
  double x = 0, y = 0;
};
/// Estimates them by a jackknife over 16 blocks (Efron 1982, doi:10.1137/1.9781611970319): so they
/// hold for heights that go together over distances up to a block's. Blocks without which no plane
/// is determined do not count.
SlopeDoubt doubt_of_plane(const HeightField& field, const Mask& use = {});

/// Fits a polynomial with all terms x^i y^j, i + j <= degree (0 to 6), and evaluates it at every
/// sample, also in holes. Far from the samples used it is meaningless. Throws InvalidInput if the
/// samples do not determine the polynomial, UsageError for another degree.
Grid<double> fit_polynomial(const HeightField& field, int degree, const Mask& use = {});

/// Subtracts the plane or the background from the heights; holes stay as they are.
void subtract(HeightField& field, const Plane& plane);
void subtract(HeightField& field, const Grid<double>& background);

}  // namespace surf
