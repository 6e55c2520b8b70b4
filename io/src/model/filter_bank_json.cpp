// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "model/facet_json.h"
#include "model/model_kinds.h"

namespace surf::io {
namespace {

nlohmann::ordered_json write(const ModelParameters& parameters) {
  const auto& p = std::get<FilterBankParameters>(parameters);
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["multi_resolution"] = p.multi_resolution;
  json["scales"] = nlohmann::ordered_json::array();
  for (const FacetScale& scale : p.scales) json["scales"].push_back(facet_json(scale));
  json["channels"] = nlohmann::ordered_json::array();
  for (const FilterBankChannel& c : p.channels)
    json["channels"].push_back({{"name", c.name},
                                {"offset", c.offset},
                                {"slope", c.slope},
                                {"max_curvature_nm", c.max_curvature},
                                {"min_curvature_nm", c.min_curvature}});
  return json;
}

ModelParameters read(const JsonValue& value) {
  FilterBankParameters p;
  p.multi_resolution = value.require("multi_resolution").boolean();
  value.require("scales");
  for (const JsonValue& scale : value.items("scales")) p.scales.push_back(facet_of(scale));
  value.require("channels");
  for (const JsonValue& item : value.items("channels")) {
    FilterBankChannel c;
    c.name = item.require("name").text();
    c.offset = item.require("offset").number();
    for (const char* key : {"slope", "max_curvature_nm", "min_curvature_nm"}) item.require(key);
    c.slope = item.numbers("slope");
    c.max_curvature = item.numbers("max_curvature_nm");
    c.min_curvature = item.numbers("min_curvature_nm");
    p.channels.push_back(std::move(c));
  }
  return p;
}

}  // namespace

const ModelKind filter_bank_kind{"filter bank", holds<FilterBankParameters>, write, read};

}  // namespace surf::io
