// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape_from_shading.h"

namespace surf::bench {

/// Horn's method: heights z and gradients (p, q) are unknowns side by side, which minimise
///   sum of (E - R(p, q))^2 + smoothness (|grad p|^2 + |grad q|^2)
///          + integrability ((z_x - p)^2 + (z_y - q)^2),
/// lengths in pixels. R is linearised about each pixel's gradient. The smoothness stabilises the
/// relaxation and falls towards zero (B. K. P. Horn 1990, "Height and gradient from shading",
/// doi:10.1007/BF00056771). Gradients lie on pixels and heights on their corners; borders are
/// natural.
struct HornOptions {
  int levels = 1;  ///< >= 1: coarse to fine, each with half the pixels along a side; 1: one alone
  double first_smoothness = 0.3;   ///< > 0; each next one is half of it
  double last_smoothness = 0.003;  ///< > 0, at most the first
  double integrability = 0.3;      ///< > 0
  int sweeps = 200;                ///< for each smoothness, at most
  double tolerance = 1e-4;  ///< a smoothness ends when gradients change by less (rms) in a sweep
};

/// Returns heights in nm whose constant is that of `start_nm`, as the image does not show it.
/// `so_far` is called after each smoothness.
Grid<double> shape_by_horn(const ShadedImage& image, const Grid<double>& start_nm,
                           const HornOptions& options = {}, const HeightsSoFar& so_far = {});

}  // namespace surf::bench
