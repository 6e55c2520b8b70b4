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

/// A surface at the model's pixel size, and where its image is or will be.
struct TrainingSurface {
  std::string name;
  HeightField field;
  std::string sha256;
  /// The image that is given, in a file or as it is. Neither: it is to be simulated.
  std::filesystem::path image;
  std::shared_ptr<const Image> pixels = nullptr;

  bool has_image() const { return !image.empty() || pixels; }
};

/// The job's own surfaces or, where it has none, so many of the program's; resampled where they
/// have to be, with unique names.
std::vector<TrainingSurface> gather_surfaces(const TrainJob& job, int own,
                                             const NoteCallback& note);

/// The channels that are learnt: SE and BSE, or the one signal.
std::vector<std::string> channels_of(const TrainJob& job);

/// The image that is given or the one in a file, pixel on sample of the surface. Throws FileError
/// for channels that are missing, InvalidInput for another size or pixel, or where no pixel can be
/// used.
TrainingImage read_training_image(const TrainingSurface& surface, const std::filesystem::path& file,
                                  const TrainJob& job);

/// The job's own, or NAME.training for NAME.json.
std::filesystem::path image_folder(const TrainJob& job);

struct SimulatedImages {
  std::vector<std::filesystem::path>
      files;  ///< of each surface that has none of its own, else empty
  int found = 0, made = 0;
  ManyDone runs;  ///< those that were made, and whether all were
};

/// Simulates what is not there yet. Of a team each process simulates whole images, into a folder
/// that all see; few that are left over they share, unless each is to be `whole`. The leader's
/// counts are the true ones.
SimulatedImages simulate_images(const TrainJob& job, const std::vector<TrainingSurface>& surfaces,
                                const Reporter& reporter, Team* team = nullptr, bool whole = false);

}  // namespace surf::workflow
