// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/progress.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/results/simulation_result.h"
#include "surf/workflow/estimate_options.h"

namespace surf::workflow {

/// Guided images of a scene while its electrons are still counted: guides are made once, for any
/// number of estimates.
class GuidedView {
 public:
  /// Throws FileError for a model that cannot be read, Interrupted.
  GuidedView(const mc::Scene& scene, const EstimateOptions& options,
             const std::filesystem::path& cache, int threads, const Watch& watch = {});
  ~GuidedView();

  /// Like `mc::make_image`, estimated with guides. The result needs `odd_counts`, and is of the
  /// whole scan.
  Image image(const mc::SimulationResult& result, const Watch& watch = {}) const;

 private:
  struct Guides;
  std::unique_ptr<Guides> guides_;
};

}  // namespace surf::workflow
