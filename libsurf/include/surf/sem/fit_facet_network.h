// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/sem/facet_network.h"
#include "surf/sem/trained_model.h"
#include "surf/sem/training_image.h"

namespace surf {

struct FacetNetworkFitOptions {
  std::vector<FacetScale> scales;    ///< empty: `network_scales`
  std::vector<double> sky_edges_nm;  ///< empty: `network_sky_edges`
  /// The range of electrons in the material, nm, > 0: the surface farther away hardly matters.
  /// Determines the default scales and bands.
  double range_nm = 30;
  bool sided = false;           ///< some channel looks from a side: see FacetNetworkParameters
  std::vector<int> hidden{32};  ///< units of each hidden layer: 0 to 3 layers of 1 to 256 units
  int iterations = 600;  ///< largest number of iterations of the optimiser in all, 1 to 100,000
  /// Penalty of large weights, >= 0: this times the sum of their squares is added to the mean
  /// square of the standardised residuals.
  double decay = 1e-4;
  /// Expected error of the model relative to the signal, 0 to 1. Residuals are divided by the
  /// standard deviation of this error and the noise together.
  double tolerance = 0.03;
  std::uint64_t seed = 1;  ///< for the initial weights
  int threads = 0;         ///< 0: one per hardware thread. Does not change the result
  Watch watch;             ///< throws Interrupted
};

/// Throws UsageError for options out of range.
void validate(const FacetNetworkFitOptions& options);

/// The thesis's neighbourhoods with sigma up to 0.65 times the range, but at least four of them.
std::vector<FacetScale> network_scales(double pixel_nm, double range_nm);

/// Six bands of distances, up to 16/3 of the range. They extend farther than electrons travel
/// inside the material, because the surface there still catches emitted electrons. The limits are
/// at most 128 pixels, which leaves out bands for long ranges.
std::vector<double> network_sky_edges(double pixel_nm, double range_nm);

struct FacetNetworkFit {
  FacetNetworkParameters parameters;
  /// Mean square of the standardised residuals; near 1 if only noise is left.
  double cost = 0;
  int iterations = 0;
  std::vector<ModelResidual> residuals;  ///< on the training images, one per channel
  std::vector<std::string> warnings;     ///< sentences with reasons not to trust the model
};

/// Trains a network on images by L-BFGS (Ceres), on all used pixels at once, in rounds. The
/// standard deviations of residuals come from the network's own images: those of noisy pixels would
/// favour pixels that happen to be dark. If there are standard errors, the noise's variance is
/// proportional to the signal, with a factor for each image from its standard errors; otherwise all
/// pixels have the same weight. Throws InvalidInput for images that cannot be used, of different or
/// non-square pixels, or with a channel whose mean is not above 0; UsageError for options out of
/// range.
FacetNetworkFit fit_facet_network(const std::vector<TrainingImage>& images,
                                  const std::vector<std::string>& channels,
                                  const FacetNetworkFitOptions& options = {});

}  // namespace surf
