// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/progress.h"
#include "surf/sem/facet_network.h"

namespace surf {

/// What a network is to learn, pixel by pixel.
struct TrainerData {
  int inputs = 0, outputs = 0;
  std::vector<float> x;       ///< [pixel][input]
  std::vector<float> y;       ///< [pixel][output]
  std::vector<int> image;     ///< [pixel]: the image that it is of
  std::vector<double> noise;  ///< [image][output]: variance of the noise over the signal
  bool has_noise = false;     ///< without, all pixels weigh alike
  double tolerance = 0;       ///< see FacetNetworkFitOptions
};

struct TrainerOptions {
  int iterations;
  double decay;
  int threads;
  Watch watch;
};

struct TrainerResult {
  double cost = 0;  ///< mean over pixels and outputs, without what the weights add
  int iterations = 0;
};

/// Improves the layers. Same bytes for any number of threads. Throws Interrupted.
TrainerResult train_network(const TrainerData& data, const TrainerOptions& options,
                            std::vector<DenseLayer>& layers);

}  // namespace surf
