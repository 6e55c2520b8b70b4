// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/filter_bank.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bank_engine.h"
#include "facet_kernels.h"
#include "sem/model/engine_model.h"
#include "sem/model/model_input.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double most_coefficient = 1e12;

void check(const std::vector<double>& values, std::size_t scales,
           const FilterBankChannel& channel) {
  if (values.size() != scales)
    throw InvalidInput("filter bank",
                       fmt::format("channel {} has {} coefficients of a kind for {} scales",
                                   channel.name, values.size(), scales),
                       "Give one for each scale");
  for (const double value : values)
    if (!(std::abs(value) <= most_coefficient))
      throw InvalidInput("filter bank",
                         fmt::format("a coefficient of channel {} is {}", channel.name, value),
                         fmt::format("Coefficients lie within +-{:g}", most_coefficient));
}

void check(const FilterBankParameters& parameters) {
  if (parameters.scales.empty() || parameters.scales.size() > 64)
    throw InvalidInput("filter bank", fmt::format("it has {} scales", parameters.scales.size()),
                       "Give 1 to 64");
  for (const FacetScale& scale : parameters.scales) facet_kernel(scale, 1);
  for (const FilterBankChannel& channel : parameters.channels) {
    if (!(std::abs(channel.offset) <= most_coefficient))
      throw InvalidInput(
          "filter bank",
          fmt::format("the offset of channel {} is {}", channel.name, channel.offset),
          fmt::format("It lies within +-{:g}", most_coefficient));
    for (const auto* values : {&channel.slope, &channel.max_curvature, &channel.min_curvature})
      check(*values, parameters.scales.size(), channel);
  }
}

struct FilterBank {
  using Parameters = FilterBankParameters;
  template <class Work>
  static auto run(const Parameters& parameters, double pitch_x_nm, double pitch_y_nm,
                  const ModelOptions& options, const Work& work) {
    return run_bank(parameters, pitch_x_nm, pitch_y_nm, options, work);
  }
};

}  // namespace

std::vector<FacetScale> thesis_scales() {
  return {{5, 0.6},    {7, 0.8485}, {9, 1.2},    {11, 1.697}, {15, 2.4},
          {21, 3.394}, {29, 4.8},   {41, 6.788}, {59, 9.6},   {83, 13.58}};
}

std::shared_ptr<const ImageModel> make_filter_bank(const ModelScope& scope,
                                                   const FilterBankParameters& parameters) {
  std::vector<std::string> names;
  for (const FilterBankChannel& channel : parameters.channels) names.push_back(channel.name);
  check_channels(names, "filter bank");
  check(parameters);
  return std::make_shared<EngineModel<FilterBank>>(scope, std::move(names), parameters);
}

}  // namespace surf
