// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/placed_image.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/stored_model.h"

namespace surf::workflow {

/// What Monte Carlo is to simulate, to correct a model by.
struct CorrectionRequest {
  mc::Material material;
  mc::Physics physics;
  std::int64_t electrons = 32;  ///< per pixel
  std::uint64_t seed = 1;
  std::filesystem::path cache;  ///< of libraries of cascades; empty: none
  int threads = 0;
};

/// What a model is off by at a surface: guided Monte Carlo less the model's images, as far as that
/// is more than chance.
struct ModelCorrection {
  ModelImages off;           ///< per channel of the model, in yields, on the image's pixels
  ModelImages error;         ///< root mean square error of `off`, from few electrons
  std::vector<double> mean;  ///< yield of each channel over the image
  std::int64_t primaries = 0;
  double seconds = 0;
};

/// Whether a model has the channels and conditions that can be simulated.
bool can_be_corrected(const StoredModel& model, const mc::Material& material);

/// Simulates the image of `surface`, in the frame of `sem` and beyond it, at the pixels of `sem`.
/// Throws Interrupted, and what simulations throw.
ModelCorrection correction_at(const HeightField& surface, const PlacedImage& sem,
                              const StoredModel& model, const CorrectionRequest& request,
                              const Reporter& reporter);

}  // namespace surf::workflow
