// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/core/placed_image.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sem_file.h"
#include "surf/registration/landmarks.h"
#include "surf/registration/register_images.h"
#include "surf/workflow/afm_preparation.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/stored_model.h"

namespace surf::workflow {

/// A scan and what is to be done to it.
struct AfmInput {
  HeightField scan;
  std::filesystem::path file;
  AfmPreparationOptions preparation;
  io::HeightReadOptions reading = {};  ///< how the file was read: of the record
};
void describe(ParameterVisitor& visit, AfmInput& input);

struct SemInput {
  PlacedImage image;
  std::filesystem::path file;
  io::SemReadOptions reading = {};  ///< as of AfmInput
};
void describe(ParameterVisitor& visit, SemInput& input);

/// How the two images come to lie on each other.
struct PoseOptions {
  std::optional<Affine> transform;      ///< SEM to AFM, known: nothing is searched for
  std::string transform_doubt;          ///< what its file says of it where it is not verified
  std::vector<LandmarkPair> landmarks;  ///< none: the start is searched for
  bool landmarks_only = false;          ///< the map of the landmarks is not refined
  RegistrationOptions registration;
  bool accept_unverified = false;  ///< go on with a registration that is not verified
};
/// registration.objective, registration.transform and so on; not the landmarks.
void describe(ParameterVisitor& visit, PoseOptions& options);

struct Pose {
  Affine sem_to_afm;
  std::optional<LandmarkFit> landmarks;
  std::optional<Registration> registration;  ///< absent: given, or by landmarks alone
  PlacedImage
      simulated;  ///< of the eroded scan, in the AFM's frame: what the SEM image was laid on

  bool verified() const {
    return !registration || registration->verdict == RegistrationVerdict::verified;
  }
};

struct RegisterJob {
  AfmInput afm;
  SemInput sem;
  ModelRequest model;
  PoseOptions pose;
  int threads = 0;
  std::filesystem::path transform;  ///< file to write, .json; or empty
  std::filesystem::path
      picture;  ///< both images and how they lie on each other, .png or .svg; or empty
};
void describe(ParameterVisitor& visit, RegisterJob& job);

struct RegisterSummary {
  PreparedAfm afm;
  StoredModel model;
  Pose pose;
};

/// Prepares the scan, predicts the SEM image of what is left of it when the tip is taken off, at
/// the SEM's pixel size, and registers. Files are written whatever the verdict, which they say.
/// Throws as its steps do.
RegisterSummary run(const RegisterJob& job, const Reporter& reporter = {});

/// The predicted image of a surface at the model's pixel: the sum of its channels, valid where the
/// surface is.
PlacedImage simulated_view(const HeightField& surface, const ImageModel& model, double pixel_nm,
                           int threads);

/// "verified", "ambiguous", "unconverged" or "unrelated".
const char* name(RegistrationVerdict verdict);

}  // namespace surf::workflow
