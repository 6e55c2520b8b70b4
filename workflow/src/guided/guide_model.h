// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/mc/geometry/scene.h"
#include "surf/sem/guided_estimate.h"
#include "surf/sem/image_model.h"
#include "surf/sem/shape_guides.h"
#include "surf/workflow/estimate_options.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

/// A fast model whose prediction guides an estimate.
struct GuideModel {
  std::shared_ptr<const ImageModel> model;  ///< null: there is none
  std::string identity;                     ///< name and hash of its file, for records; or "none"
  std::string reason;                       ///< why this one or none, for people
};

/// The model that is asked for, or the best one of the cache: of the same material, energy, spot
/// and physics, with the pixel nearest to the scan's. If the cache has none, one is trained into it
/// where `primaries` of the scene's simulation make that pay; 0: never. None where models do not
/// hold: oblique beams and several materials. Throws FileError for a named file that cannot be
/// read, Interrupted.
GuideModel find_guide_model(const EstimateOptions& options, const mc::Scene& scene,
                            const std::filesystem::path& cache, double primaries = 0,
                            int threads = 0, const Reporter& reporter = {});

/// Whether `find_guide_model` would train a model.
bool trains_guide_model(const EstimateOptions& options, const mc::Scene& scene,
                        const std::filesystem::path& cache, double primaries);

/// What the model predicts of the seen surface, as guides named after its channels. The surface is
/// resampled to the model's pixels and the images back. Empty without a model.
std::vector<Guide> predicted_guides(const GuideModel& model, const SeenSurface& surface,
                                    int threads, const Watch& watch);

}  // namespace surf::workflow
