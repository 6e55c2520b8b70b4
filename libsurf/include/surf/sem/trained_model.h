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

/// How far a model is off on a set of images, per channel. Noise is not the model's fault: where
/// the images' own standard error is known its variance is subtracted.
struct ModelResidual {
  std::string channel;
  double rms = 0;        ///< of prediction less image, the noise subtracted; counts per primary
  double noise_rms = 0;  ///< of the images' standard error
  double mean_relative =
      0;  ///< mean of |prediction - image| / image where that is above 0, noise included
  double mean_signal = 0;
  std::int64_t pixels = 0;
};

/// A surface that a model was trained on.
struct TrainingScene {
  std::string name;
  std::string sha256;                    ///< of the file, or of the made surface's heights
  int width = 0, height = 0;             ///< pixels
  std::int64_t electrons = 0;            ///< per pixel; 0: unknown or spent by accuracy
  bool held_out = false;                 ///< not learnt from: the model was only judged on it
  std::vector<ModelResidual> residuals;  ///< on its images, per channel; or none
};

/// Where a model comes from: kept in its file for whoever uses it.
struct TrainingRecord {
  std::vector<TrainingScene> scenes;
  std::vector<ModelResidual> residuals;           ///< on the training images
  std::vector<ModelResidual> held_out_residuals;  ///< on those held out; none without
  SurfaceRange range;                             ///< of the surfaces learnt from
  double condition_number = 0;                    ///< of the least squares; 0: none was solved
  std::vector<std::string> warnings;              ///< as they were shown at training
  std::map<std::string, std::string> notes;       ///< command, version, seed, physics ...
};

/// Everything that a model file holds.
struct TrainedModel {
  ModelScope scope;
  std::variant<SlopeModelParameters, FilterBankParameters, StoppingPointParameters,
               DiffusionMatrixParameters, FacetNetworkParameters>
      parameters;
  TrainingRecord record;
};

/// The model itself. Throws InvalidInput for parameters out of range.
std::shared_ptr<const ImageModel> make_model(const TrainedModel& trained);

}  // namespace surf
