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

/// What a fast model of SEM images is needed for.
struct ModelRequest {
  std::filesystem::path
      file;               ///< the model; empty: one that was kept is found, or trained and kept
  mc::Material material;  ///< empty name: whatever `file` is for; without a file it is needed
  double energy_ev = 0;   ///< 0: whatever `file` is for; else 1 keV
  double spot_nm = 0;     ///< of the beam, standard deviation
  bool spot_given = false;
  double pixel_nm = 0;  ///< > 0
  mc::Physics physics;
  std::filesystem::path
      folder;  ///< where models are kept, as cache_folder() / "models"; created where missing
  LearnOptions learn;           ///< of a training
  std::optional<int> surfaces;  ///< as in TrainJob, as are the next two
  int surface_px = TrainJob{}.surface_px;
  std::int64_t electrons = mc::electrons_of(training_simulation().budget);
  int threads = 0;
};
/// reconstruction.model, beam.energy, beam.spot and job.cache; not the material.
void describe(ParameterVisitor& visit, ModelRequest& request);

struct StoredModel {
  TrainedModel trained;
  std::shared_ptr<const ImageModel> model;
  std::filesystem::path file;
  std::string sha256;  ///< of the file
  bool made = false;   ///< it was trained just now
};

/// The name that a trained model is kept by: si-1000ev-10nm-HASH.json, the hash of all that it
/// depends on: material, energy, spot, pixel, physics, learning and the version of semsurf.
std::string kept_name(const ModelRequest& request);

/// Reads the model given, or the one kept; else trains it, which takes minutes, and keeps it. A
/// training that was interrupted or killed is gone on with. A kept file that cannot be read is
/// trained anew. Throws UsageError where the file is of another material, energy or spot,
/// InvalidInput for another pixel size, FileError, Interrupted.
StoredModel find_model(const ModelRequest& request, const Reporter& reporter = {});

}  // namespace surf::workflow
