// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "run_many.h"
#include "surf/sem/training_image.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {

/// A surface at the model's pixel size, and its image.
struct TrainingSurface {
  std::string name;
  HeightField field;
  std::string sha256;
  /// The given image, in a file or in memory. If both are empty, the image is simulated.
  std::filesystem::path image;
  std::shared_ptr<const Image> pixels = nullptr;

  bool has_image() const { return !image.empty() || pixels; }
};

/// The number of generated surfaces.
int own_surfaces(const TrainJob& job, bool needs_images);

/// The job's own surfaces, or `own` generated ones if it has none. They are resampled if necessary
/// and have unique names.
std::vector<TrainingSurface> gather_surfaces(const TrainJob& job, int own,
                                             const NoteCallback& note);

/// The channels to be learnt: SE, BSE and the job's detectors, or the one signal.
std::vector<std::string> channels_of(const TrainJob& job);

/// Reads the given image, or the one in a file; its pixels coincide with the surface's samples.
/// Throws FileError for missing channels, InvalidInput for another size or pixel size, or if no
/// pixel can be used.
TrainingImage read_training_image(const TrainingSurface& surface, const std::filesystem::path& file,
                                  const TrainJob& job);

/// The job's own image folder, or NAME.training for NAME.json.
std::filesystem::path image_folder(const TrainJob& job);

struct SimulatedImages {
  /// For each surface: its simulated image, or empty if it has its own.
  std::vector<std::filesystem::path> files;
  int found = 0, made = 0;
  ManyDone runs;  ///< the simulations of missing images, and whether all were made
};

/// Simulates the missing images. In a team each process simulates whole images into a folder that
/// all members see. A few that are left over are shared, unless `whole`. The leader has the true
/// counts.
SimulatedImages simulate_images(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                                const Reporter& reporter, Team* team = nullptr, bool whole = false);

}  // namespace surf::workflow
