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

/// An AFM scan and how it is prepared.
struct AfmInput {
  HeightField scan;
  std::filesystem::path file;
  AfmPreparationOptions preparation;
  io::HeightReadOptions reading = {};  ///< how the file was read, for the record
};
void describe(ParameterVisitor& visit, AfmInput& input);

struct SemInput {
  PlacedImage image;
  std::filesystem::path file;
  io::SemReadOptions reading = {};  ///< as in AfmInput
};
void describe(ParameterVisitor& visit, SemInput& input);

/// How the two images are registered.
struct PoseOptions {
  std::optional<Affine> transform;  ///< known map from SEM to AFM: no search is made
  std::string transform_doubt;      ///< the doubt stated in its file, if the map is not verified
  std::vector<LandmarkPair> landmarks;  ///< none: the initial guess is searched for
  bool landmarks_only = false;          ///< use the map fitted to the landmarks without refining it
  RegistrationOptions registration;
  bool accept_unverified = false;  ///< continue with a registration that is not verified
};
/// The parameters registration.objective, registration.transform and so on; not the landmarks.
void describe(ParameterVisitor& visit, PoseOptions& options);

/// A place of the SEM image in the scan, judged by how well one surface explains both images there.
struct JudgedPlace {
  Affine sem_to_afm;
  double disagreement = 0;  ///< negative log-likelihood of that surface, less the likeliest place's
  double probability = 1;   ///< among the places that were judged, (0, 1]
  bool explained = true;    ///< a surface leaves hardly more than noise of both images there
};

struct Pose {
  Affine sem_to_afm;
  std::optional<LandmarkFit> landmarks;
  /// Absent: the map was given, or fitted to landmarks alone.
  std::optional<Registration> registration;
  /// SEM image predicted from the eroded scan, in the AFM's frame; the SEM image was registered to
  /// it.
  PlacedImage simulated;
  /// Places that rival each other, judged by both images, likeliest first. Empty: there were none.
  std::vector<JudgedPlace> places;
  /// False: the registration names more rivals than were judged.
  bool every_rival_judged = true;

  /// Both images together prefer one of the places that were judged.
  bool preferred() const {
    return !places.empty() && places.front().explained && places.front().probability >= 0.95;
  }
  /// Both images together say which place is meant. Where they slide on each other, or where more
  /// places rival than were judged, they do not.
  bool decided() const {
    return preferred() && every_rival_judged && !(registration && registration->slides);
  }
  bool verified() const {
    return !registration || registration->verdict == RegistrationVerdict::verified || decided();
  }
};

struct RegisterJob {
  AfmInput afm;
  SemInput sem;
  ModelRequest model;
  PoseOptions pose;
  int threads = 0;
  std::filesystem::path transform;  ///< transform file to write, .json; or empty
  /// Picture of both images laid on each other, .png or .svg; or empty.
  std::filesystem::path picture;
};
void describe(ParameterVisitor& visit, RegisterJob& job);

struct RegisterSummary {
  PreparedAfm afm;
  StoredModel model;
  Pose pose;
};

/// Prepares the scan, predicts the SEM image of the eroded scan at the SEM's pixel size, and
/// registers the images. A blind tip is then replaced by one that is found with the SEM image, if
/// that explains it better, and the images are registered again. Files are written for every
/// verdict, which they state. Throws what its steps throw.
RegisterSummary run(const RegisterJob& job, const Reporter& reporter = {});

/// The predicted image of a surface at the model's pixel size: the sum of its channels, valid where
/// the surface is.
PlacedImage simulated_view(const HeightField& surface, const ImageModel& model, double pixel_nm,
                           int threads);

/// "verified", "ambiguous", "unconverged" or "unrelated".
const char* name(RegistrationVerdict verdict);

}  // namespace surf::workflow
