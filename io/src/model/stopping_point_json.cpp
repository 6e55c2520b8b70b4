// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "model/model_kinds.h"
#include "model/table_json.h"

namespace surf::io {
namespace {

nlohmann::ordered_json write(const ModelParameters& parameters) {
  const auto& p = std::get<StoppingPointParameters>(parameters);
  nlohmann::ordered_json json = table_json(p);
  for (const StoppingPointChannel& c : p.channels)
    json["channels"].push_back(
        {{"name", c.name},
         {"rule", c.rule == StoppingRule::reflected ? "reflected" : "counted"},
         {"density_per_nm", c.density_per_nm}});
  return json;
}

ModelParameters read(const JsonValue& value) {
  StoppingPointParameters p;
  read_table(value, p);
  for (const JsonValue& item : value.items("channels")) {
    StoppingPointChannel c;
    c.name = item.require("name").text();
    const JsonValue rule = item.require("rule");
    if (rule.text() == "reflected") c.rule = StoppingRule::reflected;
    else if (rule.text() != "counted") rule.fail(fmt::format("there is no rule '{}'", rule.text()));
    item.require("density_per_nm");
    c.density_per_nm = item.numbers("density_per_nm");
    p.channels.push_back(std::move(c));
  }
  return p;
}

}  // namespace

const ModelKind stopping_point_kind{"stopping points", holds<StoppingPointParameters>, write, read};

}  // namespace surf::io
