// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/sem/image_model.h"
#include "surf/sem/trained_model.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// The requirements on a fast model of SEM images.
struct ModelRequest {
  /// The model file; empty: a stored model is used, or one is trained and stored.
  std::filesystem::path file;
  mc::Material material;  ///< empty name: the material of `file`; required without a file
  double energy_ev = 0;   ///< 0: the energy of `file`, or 1 keV without a file
  double spot_nm = 0;     ///< standard deviation of the beam
  bool spot_given = false;
  /// What the image shows: SE, BSE, a quadrant or another detector, see `detectors_of`. Empty:
  /// gains of SE and BSE, or, of a model without them, of all its channels.
  std::string signal;
  double pixel_nm = 0;  ///< > 0
  mc::Physics physics;
  /// Folder of stored models, such as cache_folder() / "models"; created if it is missing.
  std::filesystem::path folder;
  LearnOptions learn;           ///< options of a training
  std::optional<int> surfaces;  ///< as in TrainJob, like the next two
  int surface_px = TrainJob{}.surface_px;
  /// Per pixel of the training's images. Fewer than `train` takes: somebody waits.
  std::int64_t electrons = 60;
  int threads = 0;
};
/// The parameters reconstruction.model, reconstruction.signal, beam.energy, beam.spot and
/// job.cache; not the material.
void describe(ParameterVisitor& visit, ModelRequest& request);

/// Primaries that a training for the request follows.
double training_primaries(const ModelRequest& request);

struct StoredModel {
  TrainedModel trained;
  std::shared_ptr<const ImageModel> model;  ///< of the channels that the signal asks for
  bool sided = false;                       ///< its signal is that of a detector at a side
  std::filesystem::path file;
  std::string sha256;  ///< SHA-256 of the file
  bool made = false;   ///< it was trained in this call
};

/// The file name of a stored model: si-1000ev-10nm-HASH.json. The hash covers everything that the
/// model depends on: material, energy, spot, pixel, physics, learning and the version of semsurf.
std::string kept_name(const ModelRequest& request);

/// The detectors besides SE and BSE that a model has learnt, as its record says. Throws UsageError
/// for a record that says nonsense.
std::vector<mc::Detector> taught_by(const TrainedModel& model);

/// Reads the given model or the stored one. Otherwise trains a model, after a note of how long that
/// takes, and stores it. A training that was interrupted or killed is continued. A stored file that
/// cannot be read is trained anew. Throws UsageError if the file is for another material, energy or
/// spot, or without the signal, InvalidInput for another pixel size, FileError, Interrupted.
StoredModel find_model(const ModelRequest& request, const Reporter& reporter = {});

}  // namespace surf::workflow
