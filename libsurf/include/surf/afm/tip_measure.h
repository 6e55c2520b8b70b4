// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/tip.h"

namespace surf {

struct TipMeasureOptions {
  /// The fit uses samples that are at most this deep below the apex and connected to it, > 0. 0: as
  /// deep as 21 samples need.
  double fit_depth_nm = 0;

  /// The cone's angle is fitted between these depths, >= 0. 0 and 0: from the fitted depth down to
  /// the deepest level whose section lies within the samples.
  double cone_from_nm = 0, cone_to_nm = 0;
};

/// Measures of a tip. The structuring function and its reflection, the physical tip, have the same
/// measures.
struct TipMeasures {
  /// Radii of the paraboloid fitted to the end: the radius of mean curvature, and the smallest and
  /// largest principal radii. Infinite if flat, negative if hollow.
  double radius_nm = 0, smallest_radius_nm = 0, largest_radius_nm = 0;
  double radius_residual_nm = 0;  ///< root mean square residual of the paraboloid
  double sphere_radius_nm = 0;    ///< of the sphere fitted to the same samples; infinite if flat
  double sphere_residual_nm = 0;  ///< root mean square vertical residual of the sphere
  double fit_depth_nm = 0;        ///< as used
  int samples = 0;                ///< as used

  /// Half angle, from the axis, of the cone whose cross sections have the tip's areas, and the root
  /// mean square residual of the radii. No value if the samples end before the fitted depth.
  std::optional<double> half_angle_rad;
  double half_angle_residual_nm = 0;
};

/// Measures a tip. Throws InvalidInput for an invalid tip, options out of range, and tips with
/// fewer than 6 samples to fit.
TipMeasures measure_tip(const Tip& tip, const TipMeasureOptions& options = {});

/// Volume of the tip between its apex and `depth_nm` > 0 above it, in nm^3: the sum over samples.
double tip_volume_nm3(const Tip& tip, double depth_nm);

}  // namespace surf
