// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "model/facet_json.h"
#include "model/model_kinds.h"

namespace surf::io {
namespace {

nlohmann::ordered_json write(const ModelParameters& parameters) {
  const auto& p = std::get<FacetNetworkParameters>(parameters);
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["scales"] = nlohmann::ordered_json::array();
  for (const FacetScale& scale : p.scales) json["scales"].push_back(facet_json(scale));
  json["sky_edges_nm"] = p.sky_edges_nm;
  if (p.sided) json["sided"] = true;
  json["channels"] = nlohmann::ordered_json::array();
  for (const FacetNetworkParameters::Channel& c : p.channels)
    json["channels"].push_back({{"name", c.name}, {"scale", c.scale}});
  json["layers"] = nlohmann::ordered_json::array();
  for (const DenseLayer& layer : p.layers)
    json["layers"].push_back({{"inputs", layer.inputs},
                              {"outputs", layer.outputs},
                              {"biases", layer.biases},
                              {"weights", layer.weights}});
  return json;
}

DenseLayer layer_of(const JsonValue& value) {
  const auto count = [&](const char* key) {
    const std::uint64_t n = value.require(key).whole();
    if (n > 1 << 20) value.require(key).fail("it is too large", "Train the model again");
    return static_cast<int>(n);
  };
  DenseLayer layer;
  layer.inputs = count("inputs");
  layer.outputs = count("outputs");
  for (const char* key : {"weights", "biases"}) value.require(key);
  layer.weights = value.numbers("weights");
  layer.biases = value.numbers("biases");
  return layer;
}

ModelParameters read(const JsonValue& value) {
  FacetNetworkParameters p;
  for (const char* key : {"scales", "sky_edges_nm", "layers", "channels"}) value.require(key);
  for (const JsonValue& scale : value.items("scales")) p.scales.push_back(facet_of(scale));
  p.sky_edges_nm = value.numbers("sky_edges_nm");
  p.sided = value.boolean("sided", false);
  for (const JsonValue& layer : value.items("layers")) p.layers.push_back(layer_of(layer));
  for (const JsonValue& item : value.items("channels"))
    p.channels.push_back({item.require("name").text(), item.require("scale").number()});
  return p;
}

}  // namespace

const ModelKind facet_network_kind{"facet network", holds<FacetNetworkParameters>, write, read};

}  // namespace surf::io
