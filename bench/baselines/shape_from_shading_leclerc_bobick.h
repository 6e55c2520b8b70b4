// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape_from_shading.h"

namespace surf::bench {

/// Leclerc and Bobick's method: heights are found by conjugate gradients that minimise
///   sum of (1 - lambda) (R(p, q) - E)^2 + lambda (u^2 + v^2),
/// p and q central differences, u and v second differences along x and y, lengths in pixels. Lambda
/// falls by a factor of sqrt(2) each time a minimum is found, and the images go from coarse to
/// fine; each finer one begins and ends at half the lambda (Y. G. Leclerc and A. F. Bobick 1991,
/// "The direct computation of height from shading", doi:10.1109/CVPR.1991.139752; thesis, 2.2.4.2).
/// At the border differences are one-sided and second differences do not count.
struct LeclercBobickOptions {
  int levels = 4;  ///< >= 1, each with half the pixels along a side; 1: the image alone
  /// Of the coarsest level, in (0, 1]. 1, as published, forgets the start: a plane follows, and
  /// where R does not tell the sign of slopes, no gradient leads away from a level plane.
  double first_lambda = 1;
  double last_lambda = 1.0 / 16;  ///< of the coarsest level, above 0, at most the first
  int iterations = 100;           ///< for each lambda, at most
  double tolerance = 1e-4;  ///< a lambda ends when an iteration lowers the sum by a smaller share
};

/// Returns heights in nm whose constant is that of `start_nm`, as the image does not show it.
/// `so_far` is called after each lambda.
Grid<double> shape_by_leclerc_bobick(const ShadedImage& image, const Grid<double>& start_nm,
                                     const LeclercBobickOptions& options = {},
                                     const HeightsSoFar& so_far = {});

}  // namespace surf::bench
