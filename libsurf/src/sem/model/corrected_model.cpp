// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/corrected_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/core/error.h"

namespace surf {
namespace {

class CorrectedLinearization final : public Linearization {
 public:
  CorrectedLinearization(std::unique_ptr<Linearization> model, ModelImages images)
      : model_(std::move(model)), images_(std::move(images)) {}
  const ModelImages& images() const override { return images_; }
  Grid<double> gradient(const ModelImages& weights) const override {
    return model_->gradient(weights);
  }
  ModelImages change(const Grid<double>& dz_nm) const override { return model_->change(dz_nm); }

 private:
  std::unique_ptr<Linearization> model_;
  ModelImages images_;
};

}  // namespace

CorrectedModel::CorrectedModel(std::shared_ptr<const ImageModel> model, ModelImages off,
                               const Placement& at)
    : model_(std::move(model)), off_(std::move(off)), at_(at) {
  if (!model_ || off_.size() != model_->channels().size())
    throw InvalidInput("model's correction", "there is not one image per channel of the model",
                       "Give what each channel is off by");
  for (const Grid<double>& image : off_)
    if (image.width() != off_.front().width() || image.height() != off_.front().height() ||
        !std::ranges::all_of(image.data(), [](double v) { return std::isfinite(v); }))
      throw InvalidInput("model's correction", "an image has another size or is not finite",
                         "Give 0 where the model is right");
}

void CorrectedModel::correct(const HeightField& field, ModelImages& images) const {
  const auto left = static_cast<int>(
                 std::lround((at_.origin_x_nm - field.origin_x_nm) / field.pitch_x_nm)),
             below = static_cast<int>(
                 std::lround((at_.origin_y_nm - field.origin_y_nm) / field.pitch_y_nm));
  for (std::size_t c = 0; c < images.size(); ++c)
    for (int y = std::max(0, -below); y < std::min(off_[c].height(), images[c].height() - below);
         ++y)
      for (int x = std::max(0, -left); x < std::min(off_[c].width(), images[c].width() - left); ++x)
        images[c](x + left, y + below) += off_[c](x, y);
}

ModelImages CorrectedModel::predict(const HeightField& field, const ModelOptions& options) const {
  ModelImages images = model_->predict(field, options);
  correct(field, images);
  return images;
}

std::unique_ptr<Linearization> CorrectedModel::linearize(const HeightField& field,
                                                         const ModelOptions& options) const {
  std::unique_ptr<Linearization> linear = model_->linearize(field, options);
  ModelImages images = linear->images();
  correct(field, images);
  return std::make_unique<CorrectedLinearization>(std::move(linear), std::move(images));
}

}  // namespace surf
