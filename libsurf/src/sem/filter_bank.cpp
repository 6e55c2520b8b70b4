// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/filter_bank.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bank_engine.h"
#include "facet_kernels.h"
#include "model_input.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double most_coefficient = 1e12;

void check(const std::vector<double>& values, std::size_t scales, const FilterBankChannel& channel) {
  if (values.size() != scales)
    throw InvalidInput("filter bank", fmt::format("channel {} has {} coefficients of a kind for {} scales",
                                                  channel.name, values.size(), scales),
                       "Give one for each scale");
  for (const double value : values)
    if (!(std::abs(value) <= most_coefficient))
      throw InvalidInput("filter bank", fmt::format("a coefficient of channel {} is {}", channel.name, value),
                         fmt::format("Coefficients lie within +-{:g}", most_coefficient));
}

void check(const FilterBankParameters& parameters) {
  if (parameters.scales.empty() || parameters.scales.size() > 64)
    throw InvalidInput("filter bank", fmt::format("has {} scales", parameters.scales.size()), "Give 1 to 64");
  for (const FacetScale& scale : parameters.scales) facet_kernel(scale, 1);
  for (const FilterBankChannel& channel : parameters.channels) {
    if (!(std::abs(channel.offset) <= most_coefficient))
      throw InvalidInput("filter bank", fmt::format("the offset of channel {} is {}", channel.name, channel.offset),
                         fmt::format("It lies within +-{:g}", most_coefficient));
    for (const auto* values : {&channel.slope, &channel.max_curvature, &channel.min_curvature})
      check(*values, parameters.scales.size(), channel);
  }
}

class LinearFilterBank final : public Linearization {
  template <class Work>
  auto with_engine(const Work& work) const {
    return run_bank(*parameters_, pitch_x_nm_, pitch_y_nm_, options_, work);
  }

 public:
  LinearFilterBank(std::shared_ptr<const FilterBankParameters> parameters, const HeightField& field,
                   const ModelOptions& options)
      : parameters_(std::move(parameters)), options_(options), z_nm_(field.z_nm),
        pitch_x_nm_(field.pitch_x_nm), pitch_y_nm_(field.pitch_y_nm) {
    images_ = with_engine([&](const auto& engine) { return engine.predict(z_nm_); });
  }

  const ModelImages& images() const override { return images_; }

  Grid<double> gradient(const ModelImages& weights) const override {
    check_weights(weights, images_.size(), z_nm_);
    return with_engine([&](const auto& engine) { return engine.gradient(z_nm_, weights); });
  }

  ModelImages change(const Grid<double>& dz_nm) const override {
    check_change(dz_nm, z_nm_);
    return with_engine([&](const auto& engine) { return engine.change(z_nm_, dz_nm); });
  }

 private:
  std::shared_ptr<const FilterBankParameters> parameters_;
  ModelOptions options_;
  Grid<double> z_nm_;   // the derivatives are made anew from it: as fast as to read them, and a tenth the memory
  double pitch_x_nm_, pitch_y_nm_;
  ModelImages images_;
};

class FilterBank final : public ImageModel {
 public:
  FilterBank(const ModelScope& scope, const FilterBankParameters& parameters)
      : scope_(scope), parameters_(std::make_shared<FilterBankParameters>(parameters)) {
    for (const FilterBankChannel& channel : parameters.channels) names_.push_back(channel.name);
    check_channels(names_, "filter bank");
    check(parameters);
  }

  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return scope_; }

  ModelImages predict(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    return run_bank(*parameters_, field.pitch_x_nm, field.pitch_y_nm, options,
                    [&](const auto& engine) { return engine.predict(field.z_nm); });
  }

  std::unique_ptr<Linearization> linearize(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    return std::make_unique<LinearFilterBank>(parameters_, field, options);
  }

 private:
  ModelScope scope_;
  std::shared_ptr<const FilterBankParameters> parameters_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<FacetScale> thesis_scales() {
  return {{5, 0.6},  {7, 0.8485}, {9, 1.2},  {11, 1.697}, {15, 2.4},
          {21, 3.394}, {29, 4.8}, {41, 6.788}, {59, 9.6}, {83, 13.58}};
}

std::shared_ptr<const ImageModel> make_filter_bank(const ModelScope& scope, const FilterBankParameters& parameters) {
  return std::make_shared<FilterBank>(scope, parameters);
}

}  // namespace surf
