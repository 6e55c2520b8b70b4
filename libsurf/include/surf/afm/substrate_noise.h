// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/hough_plane.h"
#include "surf/afm/noise_estimate.h"
#include "surf/core/mask.h"

namespace surf {

/// The noise of the substrate of a scan with features on it.
struct SubstrateNoise {
  HoughSummary plane;          ///< what the substrate is
  Mask substrate;              ///< 1 for the samples that the estimate is from
  double substrate_share = 0;  ///< of the samples that take part
  NoiseEstimate estimate;
  Grid<double> residual_nm;  ///< the heights less a polynomial through the substrate
};

/// Finds the plane most samples lie on (`find_plane`) and estimates the noise
/// (`estimate_flat_noise`) from what lies within four of its own standard deviations of that plane,
/// and three tolerances of it at most: the inliers themselves are cut off too close to the plane,
/// which would make the noise too small. The foot of features counts as noise where it is within.
/// Only as good as `plane.verdict` says. Throws as these two do.
SubstrateNoise estimate_substrate_noise(const HeightField& field,
                                        const FlatNoiseOptions& options = {}, const Mask& use = {});

}  // namespace surf
