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
  /// How far electrons get in the material, nm, > 0: what lies farther away hardly matters. For the
  /// scales and bands that are not given.
  double range_nm = 30;
  std::vector<int> hidden{32};  ///< units of each hidden layer, 0 to 3 layers of 1 to 256
  int iterations = 600;         ///< of the optimiser at most, in all, 1 to 100,000
  /// How strongly large weights are held back, >= 0: the sum of their squares times this is added
  /// to the mean square of the residuals in units of their standard deviation.
  double decay = 1e-4;
  /// What the model is expected to miss by, relative to the signal, 0 to 1: together with the noise
  /// it makes up the deviation that a residual is measured in.
  double tolerance = 0.03;
  std::uint64_t seed = 1;  ///< of the weights that the optimiser starts from
  int threads = 0;         ///< 0: one per hardware thread. Does not change the result
  Watch watch;             ///< throws Interrupted
};

/// Throws UsageError for options out of range.
void validate(const FacetNetworkFitOptions& options);

/// The thesis's neighbourhoods with a sigma of at most 0.65 times the range, at least four.
std::vector<FacetScale> network_scales(double pixel_nm, double range_nm);

/// Six bands of distances, up to 16/3 of the range: farther than electrons get inside, because what
/// stands there still catches those that have left. At most 128 pixels, which leaves out bands of
/// long ranges.
std::vector<double> network_sky_edges(double pixel_nm, double range_nm);

struct FacetNetworkFit {
  FacetNetworkParameters parameters;
  double cost = 0;  ///< mean square of residuals in their deviations; near 1 is noise alone
  int iterations = 0;
  std::vector<ModelResidual> residuals;  ///< on the training images, one for each channel
  std::vector<std::string> warnings;     ///< sentences: why the model may not be trusted
};

/// Learns a network from images by L-BFGS (Ceres) on all used pixels at once, in rounds: the
/// deviations that residuals are measured in come from the network's own images, because the noise
/// of a pixel would favour those that happen to be dark. With standard errors the noise's variance
/// goes with the signal as theirs does, image by image; without, all pixels weigh alike. Throws
/// InvalidInput for images that cannot be used, of different or oblong pixels, or of a channel
/// whose mean is not above 0; UsageError for options out of range.
FacetNetworkFit fit_facet_network(const std::vector<TrainingImage>& images,
                                  const std::vector<std::string>& channels,
                                  const FacetNetworkFitOptions& options = {});

}  // namespace surf
