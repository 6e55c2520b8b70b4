// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/facet_network.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "network_engine.h"
#include "sem/facet/facet_kernels.h"
#include "sem/model/engine_model.h"
#include "sem/model/model_input.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr const char* subject = "facet network";
constexpr double most = 1e6;  // largest weight or bias
constexpr int widest_layer = 1024;

void check_layer(const DenseLayer& layer, std::size_t number, int inputs) {
  if (layer.inputs != inputs || layer.outputs < 1 || layer.outputs > widest_layer)
    throw InvalidInput(
        subject,
        fmt::format("layer {} goes from {} to {} numbers", number + 1, layer.inputs, layer.outputs),
        fmt::format("It takes {} and gives 1 to {}", inputs, widest_layer));
  const std::size_t weights = static_cast<std::size_t>(layer.inputs) * layer.outputs;
  if (layer.weights.size() != weights ||
      layer.biases.size() != static_cast<std::size_t>(layer.outputs))
    throw InvalidInput(subject,
                       fmt::format("layer {} has {} weights and {} biases", number + 1,
                                   layer.weights.size(), layer.biases.size()),
                       fmt::format("Give {} and {}", weights, layer.outputs));
  for (const auto* numbers : {&layer.weights, &layer.biases})
    for (const double value : *numbers)
      if (!(std::abs(value) <= most))
        throw InvalidInput(subject, fmt::format("a number of layer {} is {}", number + 1, value),
                           fmt::format("They lie within +-{:g}", most));
}

void check(const FacetNetworkParameters& p) {
  if (p.scales.empty() || p.scales.size() > 32)
    throw InvalidInput(subject, fmt::format("it has {} scales", p.scales.size()), "Give 1 to 32");
  for (const FacetScale& scale : p.scales) facet_kernel(scale, 1);
  if (p.sky_edges_nm.size() == 1 || p.sky_edges_nm.size() > 13)
    throw InvalidInput(subject, fmt::format("it has {} limits of sky bands", p.sky_edges_nm.size()),
                       "Give none, or 2 to 13");
  for (std::size_t i = 0; i < p.sky_edges_nm.size(); ++i)
    if (i == 0 ? p.sky_edges_nm[0] != 0
               : !(p.sky_edges_nm[i] > p.sky_edges_nm[i - 1] && p.sky_edges_nm[i] < 1e5))
      throw InvalidInput(subject, fmt::format("a limit of its sky bands is {}", p.sky_edges_nm[i]),
                         "They rise from 0, in nm");
  if (p.layers.empty() || p.layers.size() > 4)
    throw InvalidInput(subject, fmt::format("it has {} layers", p.layers.size()), "Give 1 to 4");
  int inputs = network_inputs(p);
  for (std::size_t i = 0; i < p.layers.size(); ++i) {
    check_layer(p.layers[i], i, inputs);
    inputs = p.layers[i].outputs;
  }
  if (static_cast<std::size_t>(inputs) != p.channels.size())
    throw InvalidInput(subject,
                       fmt::format("it has {} outputs for {} channels", inputs, p.channels.size()),
                       "Give one for each");
  for (const FacetNetworkParameters::Channel& channel : p.channels)
    if (!(channel.scale > 0 && channel.scale <= most))
      throw InvalidInput(subject,
                         fmt::format("the scale of channel {} is {}", channel.name, channel.scale),
                         fmt::format("It lies above 0, up to {:g}", most));
}

struct FacetNetwork {
  using Parameters = FacetNetworkParameters;
  template <class Work>
  static auto run(const Parameters& parameters, double pitch_nm, double,
                  const ModelOptions& options, const Work& work) {
    if (options.double_precision) return work(NetworkEngine<double>(parameters, pitch_nm, options));
    return work(NetworkEngine<float>(parameters, pitch_nm, options));
  }
};

}  // namespace

int network_inputs(const FacetNetworkParameters& parameters) {
  const int edges = static_cast<int>(parameters.sky_edges_nm.size());
  return network::facet_inputs(parameters.sided) * static_cast<int>(parameters.scales.size()) +
         network::sky_inputs(std::max(edges - 1, 0), parameters.sided);
}

std::shared_ptr<const ImageModel> make_facet_network(const ModelScope& scope,
                                                     const FacetNetworkParameters& parameters) {
  std::vector<std::string> names;
  for (const auto& channel : parameters.channels) names.push_back(channel.name);
  check_channels(names, subject);
  check(parameters);
  if (!(scope.pixel_nm > 0 && scope.pixel_nm < 1e6))
    throw InvalidInput(subject, fmt::format("its pixels are {} nm", scope.pixel_nm),
                       "A network is learnt for one pixel size; name it");
  return std::make_shared<EngineModel<FacetNetwork>>(scope, std::move(names), parameters);
}

}  // namespace surf
