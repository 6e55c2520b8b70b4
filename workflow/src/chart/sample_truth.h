// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// What `semsurf sample` made, with all that is true of it: the scan levelled by its own tilt, tip
/// and noise; the map.
struct SampleTruth {
  std::string name;  ///< of the sample: "pads"
  HeightField scan;  ///< as the AFM gave it
  AfmData afm;
  SemData sem;        ///< without model, gains and noise until `give_model`
  HeightField truth;  ///< on the SEM image's pixels, in its frame
  std::string material;
  double energy_ev = 0, spot_nm = 0;
  std::string json;  ///< truth.json
};

/// Throws UsageError where the folder holds no sample, FileError and InvalidInput.
SampleTruth read_sample(const std::filesystem::path& folder);

/// The true gains of a model's channels, and the noise that is left when they are: chance and what
/// the model is off by.
void give_model(SampleTruth& sample, const std::shared_ptr<const ImageModel>& model,
                int threads = 0);

}  // namespace surf::workflow
