// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/sem/image_model.h"
#include "surf/sem/trained_model.h"
#include "surf/sem/training_image.h"

namespace surf {

/// Sums up how far a model is off, image by image, over as many as wanted. Pixels that are not used or
/// not finite do not count. Mean squares are weighted by nothing: every pixel counts alike.
class ResidualSum {
 public:
  explicit ResidualSum(std::vector<std::string> channels);

  /// What the model predicts for an image's field, one per channel. Throws InvalidInput for other sizes.
  void add(const ModelImages& predicted, const TrainingImage& image);

  /// Of all that was added, per channel. Where the noise alone is larger than what was found, `rms` is 0.
  std::vector<ModelResidual> residuals() const;

 private:
  struct Sums {
    double square = 0, noise = 0, relative = 0, signal = 0;
    std::int64_t pixels = 0, relative_pixels = 0;
  };
  std::vector<std::string> channels_;
  std::vector<Sums> sums_;
};

/// The residuals on one image.
std::vector<ModelResidual> judge(const ImageModel& model, const TrainingImage& image, int threads = 0);

}  // namespace surf
