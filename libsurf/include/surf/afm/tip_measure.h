// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/tip.h"

namespace surf {

struct TipMeasureOptions {
  /// Samples no deeper than this below the apex, and joined to it, are fitted, > 0. 0: as deep as
  /// takes 21 samples.
  double fit_depth_nm = 0;

  /// Depths between which the cone's angle is fitted, >= 0. 0 and 0: from the fitted depth on down
  /// to the deepest level that does not run off the samples.
  double cone_from_nm = 0, cone_to_nm = 0;
};

/// What is measured of a tip; the structuring function and the tip itself give the same.
struct TipMeasures {
  /// Of the paraboloid fitted to the end: the radius of mean curvature, and the smallest and
  /// largest principal radii. Infinite where it is flat, negative where it is hollow.
  double radius_nm = 0, smallest_radius_nm = 0, largest_radius_nm = 0;
  double radius_residual_nm = 0;  ///< root mean square of what the paraboloid leaves
  double sphere_radius_nm = 0;    ///< of the sphere fitted to the same samples; infinite where flat
  double sphere_residual_nm = 0;  ///< vertical, root mean square
  double fit_depth_nm = 0;        ///< as used
  int samples = 0;                ///< as used

  /// Half angle of the cone whose cross sections have the tip's areas, from the axis, and the root
  /// mean square of what is left of their radii. Without a value where the samples end before the
  /// fitted depth.
  std::optional<double> half_angle_rad;
  double half_angle_residual_nm = 0;
};

/// Throws InvalidInput for an invalid tip, options out of range, and tips with fewer than 6 samples
/// to fit.
TipMeasures measure_tip(const Tip& tip, const TipMeasureOptions& options = {});

/// Volume of the tip between its apex and `depth_nm` > 0 above it, in nm^3: the sum over samples.
double tip_volume_nm3(const Tip& tip, double depth_nm);

}  // namespace surf
