// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "guided/guide_model.h"
#include "surf/core/image.h"
#include "surf/mc/geometry/scene.h"
#include "surf/sem/guided_estimate.h"

namespace surf::workflow {

/// What guides the images of a scene.
struct SceneGuides {
  std::vector<Guide> shape;      ///< for all detectors
  std::vector<Guide> predicted;  ///< by a fast model, named after its channels
  /// Detectors of the same primaries whose images guide those of the others.
  std::vector<std::string> detectors;
  Grid<int> region;  ///< the material that a pixel shows; -1: the beam meets nothing

  /// Those of a detector: the prediction of its own image, or, where there is none, those of the
  /// others as mere guides; then shape.
  std::vector<Guide> of(const std::string& detector) const;
};

/// The surface and the materials that a view of a scene shows (mc::surface_view), along the beam.
/// `region` is set as in `SceneGuides`.
SeenSurface seen_surface(const Image& view, const mc::Beam& beam, Grid<int>& region);

SceneGuides guides_of(const mc::Scene& scene, const GuideModel& model, int threads,
                      const Watch& watch);

}  // namespace surf::workflow
