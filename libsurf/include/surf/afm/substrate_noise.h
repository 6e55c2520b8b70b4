// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/hough_plane.h"
#include "surf/afm/noise_estimate.h"
#include "surf/core/mask.h"

namespace surf {

/// The noise of the substrate of a scan with features on it.
struct SubstrateNoise {
  HoughSummary plane;          ///< the plane of the substrate
  Mask substrate;              ///< 1 for the samples that the estimate uses
  double substrate_share = 0;  ///< share of the samples that take part
  NoiseEstimate estimate;
  Grid<double> residual_nm;  ///< heights minus the polynomial through the substrate
};

/// Finds the plane of the substrate (`find_plane`) and estimates the noise (`estimate_flat_noise`)
/// from the samples near it: within four of their own standard deviations, and at most three
/// tolerances. The inliers of `find_plane` alone are cut off too close to the plane and would give
/// too little noise. The foot of a feature counts as noise if it is within that distance. The
/// estimate is only as good as `plane.verdict` says. Throws as `find_plane` and
/// `estimate_flat_noise` do.
SubstrateNoise estimate_substrate_noise(const HeightField& field,
                                        const FlatNoiseOptions& options = {}, const Mask& use = {});

/// Whether the "substrate" is rough ground: unlike noise, rough ground is correlated from row to
/// row (whitened neighbours in adjacent rows by more than 0.5).
bool is_rough_ground(const SubstrateNoise& found);

}  // namespace surf
