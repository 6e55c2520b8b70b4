// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// What a thin film on the specimen changes in its yields, to first order in the film's thickness.
/// Per channel: the relative change per nm is a + b c + d c^2, where c is the cosine of the angle
/// between the beam and the surface's normal. A film of 1 to 2 nm is much thinner than what a pixel
/// shows, so that the slope there is all that it depends on.
struct FilmEffect {
  std::string material;  ///< of the film
  std::vector<std::array<double, 3>> per_nm;
};

/// The relative change of a yield per nm of film, and its standard error, at a cosine.
struct FilmPoint {
  double cosine = 1, per_nm = 0, standard_error = 1;
};

/// The numbers a, b, c of a channel that fit these points best, by weighted least squares. Throws
/// InvalidInput for fewer than three cosines, or standard errors that are not above 0.
std::array<double, 3> fit_film_effect(const std::vector<FilmPoint>& points);

/// A model with twice as many channels as another: those of the other, and what 1 nm of a film
/// changes in each of them. Slopes are central differences; upright beams.
class FilmModel final : public ImageModel {
 public:
  /// Throws InvalidInput if there are not three finite numbers per channel of the model.
  FilmModel(std::shared_ptr<const ImageModel> model, FilmEffect film);

  const std::vector<std::string>& channels() const override { return channels_; }
  const ModelScope& scope() const override { return model_->scope(); }
  ModelImages predict(const HeightField& field, const ModelOptions& options = {}) const override;
  std::unique_ptr<Linearization> linearize(const HeightField& field,
                                           const ModelOptions& options = {}) const override;

 private:
  std::shared_ptr<const ImageModel> model_;
  FilmEffect film_;
  std::vector<std::string> channels_;
};

}  // namespace surf
