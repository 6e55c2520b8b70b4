// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "registration/correlation.h"

namespace surf {

/// How far the largest correlation is known. The corners solve "sum of each sample's pull = 0";
/// their covariance is H^-1 V H^-1 with H the derivative of the sum (by central differences of the
/// exact gradient, so that noise in the AFM's image is not taken for structure) and V the pull's
/// variance, from sums over blocks as large as the residuals are correlated, each as if left out of
/// the fit: the "sandwich" of M-estimates (blocks: Conley 1999, doi:10.1016/S0304-4076(98)00084-0)
/// with the jackknife's weights.
struct Uncertainty {
  std::array<double, 36> covariance{};  ///< of the corners, SEM pixels squared
  double place_px = 0;  ///< root mean square over the overlap of the place's standard error
  double loosest_px =
      0;  ///< standard error along the motion that is known least, of unit root mean square
  std::array<Corners, 2> loosest{};  ///< the two least known motions, of unit root mean square
  double score = 0;                  ///< standard error of the correlation
  double block_px = 1;               ///< side of the blocks
};

/// How far edges lie from where the other image has them once the images are laid on each other:
/// what a tip does to walls and ends, which no amount of pixels averages away.
struct EdgeSlip {
  double px = 0;  ///< root mean square along each axis, of places weighed by how well they show it
  int reach_px = 0;  ///< side of blocks that are displaced on their own
};

/// From blocks a few pixels wide at a level that is blurred enough for noise not to matter.
EdgeSlip edge_slip(const BlurLevel& level, const Corners& corners);

/// At an optimum; `corners` are what `fit_correlation` gave. V is the larger one of that from the
/// residuals and that of blocks displaced by the slip: where few edges hold a motion, they agree
/// with a map that was fitted to them, and only what edges do elsewhere tells how far to trust
/// them.
Uncertainty uncertainty_of(const BlurLevel& level, const Corners& corners, const EdgeSlip& slip);

/// The same of an estimate by likelihood: `information` is the negative second derivative of its
/// logarithm. `score` is left 0.
Uncertainty uncertainty_from(const std::array<double, 36>& information, const BlurLevel& level,
                             const Corners& corners);

/// How many samples are as good as one, the residuals being correlated: 1 for white ones, less
/// else.
double independent_share(const BlurLevel& level, const Corners& corners);

/// The standard error of a correlation alone.
double score_error(const BlurLevel& level, const Corners& corners);

/// Covariance of xx xy x0 yx yy y0 from that of the corners.
std::array<double, 36> affine_covariance(const CornerFrame& frame,
                                         const std::array<double, 36>& corners);

}  // namespace surf
