// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_models.h"

#include "surf/mesh/shapes.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/fit_filter_bank.h"
#include "surf/sem/surface_range.h"

namespace surf::limits {
namespace {

TrainedModel with_record(TrainedModel model, const std::vector<TrainingImage>& images) {
  model.scope = {images.front().field.pitch_x_nm, "Si", 1000, 0};
  for (const TrainingImage& image : images)
    model.record.range = united(model.record.range, surface_range(image.field));
  return model;
}

}  // namespace

HeightField rough(double rms_nm, double correlation_nm, std::uint64_t seed, int pixels,
                  double pixel_nm) {
  const double across = (pixels - 1) * pixel_nm;
  return make_rough({across, across, pixel_nm}, rms_nm, correlation_nm, seed);
}

HeightField scaled(HeightField field, double factor) {
  for (double& z : field.z_nm.data()) z *= factor;
  return field;
}

const std::vector<TrainingImage>& gentle_training() {
  static const std::vector<TrainingImage> images = [] {
    std::vector<TrainingImage> out;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) out.push_back(monte_carlo(rough(3, 15, seed)));
    return out;
  }();
  return images;
}

TrainedModel learn_bank(const std::vector<TrainingImage>& images, double cut_off) {
  FilterBankFitOptions options;
  options.eigenvalue_cutoff = cut_off;
  FilterBankFit fit = fit_filter_bank(images, {"SE", "BSE"}, options);
  TrainedModel model;
  model.parameters = fit.parameters;
  model.record.condition_number = fit.condition_number;
  model.record.warnings = fit.warnings;
  model.record.notes["components"] = std::to_string(fit.components);
  return with_record(std::move(model), images);
}

TrainedModel learn_network(const std::vector<TrainingImage>& images) {
  FacetNetworkFitOptions options;
  options.iterations = 200;
  options.hidden = {16};
  FacetNetworkFit fit = fit_facet_network(images, {"SE", "BSE"}, options);
  TrainedModel model;
  model.parameters = fit.parameters;
  model.record.warnings = fit.warnings;
  return with_record(std::move(model), images);
}

const TrainedModel& gentle_bank() {
  static const TrainedModel model = learn_bank(gentle_training());
  return model;
}

const TrainedModel& gentle_network() {
  static const TrainedModel model = learn_network(gentle_training());
  return model;
}

double se_error(const TrainedModel& model, const TrainingImage& truth) {
  return error_beyond_noise(make_model(model)->predict(truth.field).front(), truth);
}

}  // namespace surf::limits
