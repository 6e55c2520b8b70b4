// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/trained_model.h"

namespace surf {
namespace {

// One overload per kind of model.
std::shared_ptr<const ImageModel> make(const ModelScope& scope,
                                       const SlopeModelParameters& parameters) {
  return make_slope_model(scope, parameters);
}

std::shared_ptr<const ImageModel> make(const ModelScope& scope,
                                       const FilterBankParameters& parameters) {
  return make_filter_bank(scope, parameters);
}

std::shared_ptr<const ImageModel> make(const ModelScope& scope,
                                       const StoppingPointParameters& parameters) {
  return make_stopping_point(scope, parameters);
}

std::shared_ptr<const ImageModel> make(const ModelScope& scope,
                                       const DiffusionMatrixParameters& parameters) {
  return make_diffusion_matrix(scope, parameters);
}

std::shared_ptr<const ImageModel> make(const ModelScope& scope,
                                       const FacetNetworkParameters& parameters) {
  return make_facet_network(scope, parameters);
}

}  // namespace

std::shared_ptr<const ImageModel> make_model(const TrainedModel& trained) {
  return std::visit([&](const auto& parameters) { return make(trained.scope, parameters); },
                    trained.parameters);
}

}  // namespace surf
