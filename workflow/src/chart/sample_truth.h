// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// A sample made by `semsurf sample`, with its truth: the scan levelled by its true tilt, with true
/// tip and noise; the map.
struct SampleTruth {
  std::string name;  ///< of the sample: "pads"
  HeightField scan;  ///< as recorded by the AFM
  AfmData afm;
  SemData sem;        ///< without model, gains and noise until `give_model`
  HeightField truth;  ///< at the SEM image's pixels, in its frame
  std::string material;
  double energy_ev = 0, spot_nm = 0;
  std::string json;  ///< truth.json
};

/// Reads a sample. Throws UsageError if the folder holds no sample, FileError and InvalidInput.
SampleTruth read_sample(const std::filesystem::path& folder);

/// Sets the true gains of a model's channels, and the noise that remains with them: chance and the
/// error of the model.
void give_model(SampleTruth& sample, const std::shared_ptr<const ImageModel>& model,
                int threads = 0);

}  // namespace surf::workflow
