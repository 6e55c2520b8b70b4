// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// A field blurred by a Gaussian of this standard deviation. Samples near holes and the border,
/// where part of the Gaussian is missing, become holes.
HeightField smoothed(const HeightField& field, double sigma_x_nm, double sigma_y_nm);

/// Takes the plane off that fits best by least squares.
void take_plane_off(Grid<double>& values, const Mask& valid);

/// The fit from one start.
struct AlignFit {
  bool usable = false;      ///< enough samples overlap
  bool determined = false;  ///< the surfaces tell the shift along both axes
  Point2 shift_nm, centre_nm;
  double lift_nm = 0, tilt_x = 0, tilt_y = 0;
  std::array<double, 25> covariance{};
  double correlation = 0, overlap = 0;
  double place_error_px = 0;  ///< robust deviation of walls from their places
  double independent = 0;     ///< samples that are worth as much without correlation
  Pitch pitch;
};

/// Fits shift (unless `held`), lift and tilt of smoothed fields. Throws Interrupted.
AlignFit fit_alignment(const HeightField& before, const HeightField& after, Point2 start, bool held,
                       const Watch& watch);

}  // namespace surf
