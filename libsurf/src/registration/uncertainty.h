// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "registration/correlation.h"

namespace surf {

/// The uncertainty of the map with the largest correlation. The corners solve "sum of each sample's
/// pull = 0" (the pull is a sample's gradient). Their covariance is H^-1 V H^-1. H is the
/// derivative of the sum, by central differences of the exact gradient, so that noise in the AFM's
/// image is not mistaken for structure. V is the variance of the sum, from sums over blocks as
/// large as the correlation of the residuals, each as if left out of the fit: the "sandwich"
/// estimate for M-estimates (blocks: Conley 1999, doi:10.1016/S0304-4076(98)00084-0) with the
/// jackknife's weights.
struct Uncertainty {
  std::array<double, 36> covariance{};  ///< covariance of the corners, SEM pixels squared
  /// Standard error of the mapped position, root mean square over the overlap.
  double place_px = 0;
  /// Standard error along the least known motion, of unit root mean square.
  double loosest_px = 0;
  std::array<ThreePointMap, 2>
      loosest{};        ///< the two least known motions, of unit root mean square
  double score = 0;     ///< standard error of the correlation
  double block_px = 1;  ///< side of the blocks
};

/// How far edges of one image lie from the edges of the other after alignment. A tip displaces
/// walls and ends like this, and more pixels do not average it away.
struct EdgeSlip {
  /// Root mean square along each axis; places weigh more the better they show the displacement.
  double px = 0;
  int reach_px = 0;  ///< side of the blocks that are displaced independently
};

/// Measures the slip in blocks a few pixels wide. The level must be blurred so much that noise does
/// not matter.
EdgeSlip edge_slip(const BlurLevel& level, const ThreePointMap& corners);

/// The uncertainty at an optimum; `corners` come from `fit_correlation`. V is the larger one of two
/// variances: from the residuals, and from blocks displaced by the slip. If only a few edges
/// determine a motion, they agree with the map because it was fitted to them; then only the slip of
/// other edges shows how reliable they are.
Uncertainty uncertainty_of(const BlurLevel& level, const ThreePointMap& corners,
                           const EdgeSlip& slip);

/// The uncertainty of a maximum-likelihood estimate. `information` is the negative second
/// derivative of the log-likelihood. `score` is left 0.
Uncertainty uncertainty_from(const std::array<double, 36>& information, const BlurLevel& level,
                             const ThreePointMap& corners);

/// The number of independent samples per sample, given the correlation of the residuals: 1 for
/// white residuals, otherwise less.
double independent_share(const BlurLevel& level, const ThreePointMap& corners);

/// The standard error of a correlation.
double score_error(const BlurLevel& level, const ThreePointMap& corners);

/// The covariance of xx xy x0 yx yy y0, from that of the corners.
std::array<double, 36> affine_covariance(const ThreePointFrame& frame,
                                         const std::array<double, 36>& corners);

}  // namespace surf
