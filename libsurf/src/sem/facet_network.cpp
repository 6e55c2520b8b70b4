// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/facet_network.h"

#include <cmath>

#include <fmt/format.h>

#include "facet_kernels.h"
#include "model_input.h"
#include "network_engine.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr const char* subject = "facet network";
constexpr double most = 1e6;       // of a weight or a bias
constexpr int widest_layer = 1024;

void check_layer(const DenseLayer& layer, std::size_t number, int inputs) {
  if (layer.inputs != inputs || layer.outputs < 1 || layer.outputs > widest_layer)
    throw InvalidInput(subject, fmt::format("layer {} goes from {} to {} numbers", number + 1, layer.inputs, layer.outputs),
                       fmt::format("It takes {} and gives 1 to {}", inputs, widest_layer));
  const std::size_t weights = static_cast<std::size_t>(layer.inputs) * layer.outputs;
  if (layer.weights.size() != weights || layer.biases.size() != static_cast<std::size_t>(layer.outputs))
    throw InvalidInput(subject, fmt::format("layer {} has {} weights and {} biases", number + 1,
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
    throw InvalidInput(subject, fmt::format("has {} scales", p.scales.size()), "Give 1 to 32");
  for (const FacetScale& scale : p.scales) facet_kernel(scale, 1);
  if (p.sky_edges_nm.size() == 1 || p.sky_edges_nm.size() > 13)
    throw InvalidInput(subject, fmt::format("has {} limits of sky bands", p.sky_edges_nm.size()),
                       "Give none, or 2 to 13");
  for (std::size_t i = 0; i < p.sky_edges_nm.size(); ++i)
    if (i == 0 ? p.sky_edges_nm[0] != 0 : !(p.sky_edges_nm[i] > p.sky_edges_nm[i - 1] && p.sky_edges_nm[i] < 1e5))
      throw InvalidInput(subject, fmt::format("a limit of its sky bands is {}", p.sky_edges_nm[i]),
                         "They rise from 0, in nm");
  if (p.layers.empty() || p.layers.size() > 4)
    throw InvalidInput(subject, fmt::format("has {} layers", p.layers.size()), "Give 1 to 4");
  int inputs = network_inputs(p);
  for (std::size_t i = 0; i < p.layers.size(); ++i) {
    check_layer(p.layers[i], i, inputs);
    inputs = p.layers[i].outputs;
  }
  if (static_cast<std::size_t>(inputs) != p.channels.size())
    throw InvalidInput(subject, fmt::format("has {} outputs for {} channels", inputs, p.channels.size()),
                       "Give one for each");
  for (const FacetNetworkParameters::Channel& channel : p.channels)
    if (!(channel.scale > 0 && channel.scale <= most))
      throw InvalidInput(subject, fmt::format("the scale of channel {} is {}", channel.name, channel.scale),
                         fmt::format("It lies above 0, up to {:g}", most));
}

template <class Work>
auto run_network(const FacetNetworkParameters& parameters, double pitch_nm, const ModelOptions& options,
                 const Work& work) {
  if (options.double_precision) return work(NetworkEngine<double>(parameters, pitch_nm, options));
  return work(NetworkEngine<float>(parameters, pitch_nm, options));
}

class LinearFacetNetwork final : public Linearization {
 public:
  LinearFacetNetwork(std::shared_ptr<const FacetNetworkParameters> parameters, const HeightField& field,
                     const ModelOptions& options)
      : parameters_(std::move(parameters)), options_(options), z_nm_(field.z_nm), pitch_nm_(field.pitch_x_nm),
        images_(run_network(*parameters_, pitch_nm_, options_,
                            [&](const auto& engine) { return engine.predict(z_nm_); })) {}

  const ModelImages& images() const override { return images_; }

  Grid<double> gradient(const ModelImages& weights) const override {
    check_weights(weights, images_.size(), z_nm_);
    return run_network(*parameters_, pitch_nm_, options_,
                       [&](const auto& engine) { return engine.gradient(z_nm_, weights); });
  }

  ModelImages change(const Grid<double>& dz_nm) const override {
    check_change(dz_nm, z_nm_);
    return run_network(*parameters_, pitch_nm_, options_,
                       [&](const auto& engine) { return engine.change(z_nm_, dz_nm); });
  }

 private:
  std::shared_ptr<const FacetNetworkParameters> parameters_;
  ModelOptions options_;
  Grid<double> z_nm_;
  double pitch_nm_;
  ModelImages images_;
};

class FacetNetwork final : public ImageModel {
 public:
  FacetNetwork(const ModelScope& scope, const FacetNetworkParameters& parameters)
      : scope_(scope), parameters_(std::make_shared<FacetNetworkParameters>(parameters)) {
    for (const auto& channel : parameters.channels) names_.push_back(channel.name);
    check_channels(names_, subject);
    check(parameters);
    if (!(scope.pixel_nm > 0 && scope.pixel_nm < 1e6))
      throw InvalidInput(subject, fmt::format("its pixels are {} nm", scope.pixel_nm),
                         "A network is learnt for one pixel size; name it");
  }

  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return scope_; }

  ModelImages predict(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    return run_network(*parameters_, field.pitch_x_nm, options,
                       [&](const auto& engine) { return engine.predict(field.z_nm); });
  }

  std::unique_ptr<Linearization> linearize(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    return std::make_unique<LinearFacetNetwork>(parameters_, field, options);
  }

 private:
  ModelScope scope_;
  std::shared_ptr<const FacetNetworkParameters> parameters_;
  std::vector<std::string> names_;
};

}  // namespace

int network_inputs(const FacetNetworkParameters& parameters) {
  const int edges = static_cast<int>(parameters.sky_edges_nm.size());
  return network::facet_inputs * static_cast<int>(parameters.scales.size()) + (edges > 1 ? 2 * (edges - 1) + 1 : 0);
}

std::shared_ptr<const ImageModel> make_facet_network(const ModelScope& scope,
                                                     const FacetNetworkParameters& parameters) {
  return std::make_shared<FacetNetwork>(scope, parameters);
}

}  // namespace surf
