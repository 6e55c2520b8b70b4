// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/guided_view.h"

#include "guided/guide_model.h"
#include "guided/guided_images.h"
#include "guided/scene_guides.h"

namespace surf::workflow {

struct GuidedView::Guides {
  mc::Scan scan;
  int threads = 0;
  SceneGuides guides;
};

GuidedView::GuidedView(const mc::Scene& scene, const EstimateOptions& options,
                       const std::filesystem::path& cache, int threads, const Watch& watch)
    : guides_(std::make_unique<Guides>()) {
  guides_->scan = scene.scan();
  guides_->threads = threads;
  guides_->guides = guides_of(scene, find_guide_model(options, scene, cache), threads, watch);
}

GuidedView::~GuidedView() = default;

Image GuidedView::image(const mc::SimulationResult& result, const Watch& watch) const {
  const std::vector<GuidedImage> images =
      estimate_images(result, guides_->guides, guides_->threads, watch);
  ImageRows rows = mc::make_image_rows(result, guides_->scan);
  show_guided(result, images, rows);
  return to_image(rows);
}

}  // namespace surf::workflow
