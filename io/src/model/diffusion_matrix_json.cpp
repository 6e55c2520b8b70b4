// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "model/model_kinds.h"
#include "model/table_json.h"

namespace surf::io {
namespace {

nlohmann::ordered_json write(const ModelParameters& parameters) {
  const auto& p = std::get<DiffusionMatrixParameters>(parameters);
  nlohmann::ordered_json json = table_json(p);
  for (const DiffusionMatrixChannel& c : p.channels)
    json["channels"].push_back({{"name", c.name}, {"moments_per_nm2", c.moments_per_nm2}});
  return json;
}

ModelParameters read(const JsonValue& value) {
  DiffusionMatrixParameters p;
  read_table(value, p);
  for (const JsonValue& item : value.items("channels")) {
    item.require("moments_per_nm2");
    p.channels.push_back({item.require("name").text(), item.numbers("moments_per_nm2")});
  }
  return p;
}

}  // namespace

const ModelKind diffusion_matrix_kind{"diffusion matrix", holds<DiffusionMatrixParameters>, write,
                                      read};

}  // namespace surf::io
