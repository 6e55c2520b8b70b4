// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/transport/detector.h"
#include "surf/sem/training_image.h"

namespace surf::limits {

/// How images for sweeps are made.
struct Exposure {
  double energy_ev = 1000;
  std::int64_t electrons = 40;  ///< per pixel
  std::uint64_t seed = 1;       ///< of what is drawn and of the library of cascades
  double density = 1;           ///< times silicon's
  std::string material = "Si";
  std::vector<mc::Detector> detectors = mc::default_detectors();
};

/// A Monte Carlo image of a small surface by replay, with standard errors, a channel for each
/// detector. Libraries of 4096 cascades stay in memory, so that many images share them: their own
/// error, about 2 % of SE, is then common to what a model learns from and what it is compared with,
/// if the seeds are the same.
TrainingImage monte_carlo(const HeightField& surface, const Exposure& exposure = {});

/// How far a model's channel is off, relative, rms over the pixels, the noise of the image taken
/// off.
double error_beyond_noise(const Grid<double>& predicted, const TrainingImage& truth,
                          std::size_t channel = 0);

}  // namespace surf::limits
