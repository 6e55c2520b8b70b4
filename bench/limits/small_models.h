// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "monte_carlo.h"
#include "surf/sem/trained_model.h"

// Models that are learnt in a second, to see where such models fail. Silicon at 1 keV, pixels of 3
// nm.

namespace surf::limits {

/// Gaussian rough surface of 3 nm pixels about the origin.
HeightField rough(double rms_nm, double correlation_nm, std::uint64_t seed, int pixels = 32,
                  double pixel_nm = 3);

/// Heights times a factor.
HeightField scaled(HeightField field, double factor);

/// Four rough surfaces of 3 nm rms and 15 nm correlation, 32 x 32 pixels: slopes to about 45
/// degrees.
const std::vector<TrainingImage>& gentle_training();

/// With scope and range of what was learnt from, as `semsurf train` keeps them.
TrainedModel learn_bank(const std::vector<TrainingImage>& images, double cut_off = 0.1);
TrainedModel learn_network(const std::vector<TrainingImage>& images);

/// Learnt of these, once.
const TrainedModel& gentle_bank();
const TrainedModel& gentle_network();

/// Error of SE, see `error_beyond_noise`.
double se_error(const TrainedModel& model, const TrainingImage& truth);

}  // namespace surf::limits
