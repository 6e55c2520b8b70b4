// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/core/placed_image.h"
#include "surf/sem/image_model.h"

namespace surf {

/// A model with what it is off by at one place: one image per channel, in yields, on samples at
/// `at`, is added to its images. Derivatives are the model's own. Samples of a field that lie
/// outside keep what the model says.
class CorrectedModel final : public ImageModel {
 public:
  /// Throws InvalidInput if there is not one image per channel, or one is not finite.
  CorrectedModel(std::shared_ptr<const ImageModel> model, ModelImages off, const Placement& at);

  const std::vector<std::string>& channels() const override { return model_->channels(); }
  const ModelScope& scope() const override { return model_->scope(); }
  ModelImages predict(const HeightField& field, const ModelOptions& options = {}) const override;
  std::unique_ptr<Linearization> linearize(const HeightField& field,
                                           const ModelOptions& options = {}) const override;

 private:
  void correct(const HeightField& field, ModelImages& images) const;

  std::shared_ptr<const ImageModel> model_;
  ModelImages off_;
  Placement at_;
};

}  // namespace surf
