// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "surf/sem/diffusion_matrix.h"
#include "surf/sem/facet_network.h"
#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"
#include "surf/sem/slope_model.h"
#include "surf/sem/stopping_point.h"
#include "surf/sem/surface_range.h"

namespace surf {

/// The error of a model on a set of images, for one channel. Noise is not an error of the model: if
/// the standard error of the images is known, its variance is subtracted.
struct ModelResidual {
  std::string channel;
  double rms = 0;        ///< of prediction minus image, without the noise; counts per primary
  double noise_rms = 0;  ///< of the images' standard error
  /// Mean of |prediction - image| / image over pixels whose image is above 0, including the noise.
  double mean_relative = 0;
  double mean_signal = 0;
  std::int64_t pixels = 0;
};

/// A surface that a model was trained on.
struct TrainingScene {
  std::string name;
  std::string sha256;                    ///< of the file, or of the heights of a generated surface
  int width = 0, height = 0;             ///< pixels
  std::int64_t electrons = 0;            ///< per pixel; 0: unknown or set by an accuracy
  bool held_out = false;                 ///< not used for training, only for testing
  std::vector<ModelResidual> residuals;  ///< on its images, one per channel; or none
};

/// The origin of a model, stored in its file.
struct TrainingRecord {
  std::vector<TrainingScene> scenes;
  std::vector<ModelResidual> residuals;           ///< on the training images
  std::vector<ModelResidual> held_out_residuals;  ///< on the held-out images, if there are any
  SurfaceRange range;                             ///< of the training surfaces
  double condition_number = 0;                    ///< of the least squares; 0: none were solved
  std::vector<std::string> warnings;              ///< as shown during training
  std::map<std::string, std::string> notes;       ///< command, version, seed, physics ...
};

/// The content of a model file.
struct TrainedModel {
  ModelScope scope;
  std::variant<SlopeModelParameters, FilterBankParameters, StoppingPointParameters,
               DiffusionMatrixParameters, FacetNetworkParameters>
      parameters;
  TrainingRecord record;
};

/// Makes the model. Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_model(const TrainedModel& trained);

}  // namespace surf
