// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/sem/facet_network.h"

namespace surf {

/// The training data of a network, pixel by pixel.
struct TrainerData {
  int inputs = 0, outputs = 0;
  std::vector<float> x;       ///< [pixel][input]
  std::vector<float> y;       ///< [pixel][output]
  std::vector<int> image;     ///< [pixel]: number of the pixel's image
  std::vector<double> noise;  ///< [image][output]: variance of the noise divided by the signal
  bool has_noise = false;     ///< false: all pixels have the same weight
  double tolerance = 0;       ///< see FacetNetworkFitOptions
};

struct TrainerOptions {
  int iterations;
  double decay;
  int threads;
  Watch watch;
};

struct TrainerResult {
  double cost = 0;  ///< mean over pixels and outputs, without the penalty of the weights
  int iterations = 0;
};

/// Trains the layers. The result does not depend on the number of threads. Throws Interrupted.
TrainerResult train_network(const TrainerData& data, const TrainerOptions& options,
                            std::vector<DenseLayer>& layers);

}  // namespace surf
