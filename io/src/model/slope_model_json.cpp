// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "model/facet_json.h"
#include "model/model_kinds.h"

namespace surf::io {
namespace {

constexpr std::pair<SlopeForm, const char*> forms[] = {
    {SlopeForm::secant, "secant"},
    {SlopeForm::ikeuchi_exponential, "ikeuchi exponential"},
    {SlopeForm::ikeuchi_secant, "ikeuchi secant"},
    {SlopeForm::ikeuchi_mixed, "ikeuchi mixed"},
    {SlopeForm::table, "table"},
};

const char* name_of(SlopeForm form) {
  for (const auto& [known, name] : forms)
    if (known == form) return name;
  return "";
}

SlopeForm form_of(const JsonValue& value) {
  const std::string text = value.text();
  std::string names;
  for (const auto& [form, name] : forms) {
    if (text == name) return form;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  value.fail(fmt::format("there is no form '{}'", text), fmt::format("Known are {}", names));
}

nlohmann::ordered_json write(const ModelParameters& parameters) {
  const auto& p = std::get<SlopeModelParameters>(parameters);
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["form"] = name_of(p.form);
  json["table_step_deg"] = p.table_step_deg;
  json["facet"] = facet_json(p.facet);
  json["channels"] = nlohmann::ordered_json::array();
  for (const SlopeChannel& c : p.channels)
    json["channels"].push_back(
        {{"name", c.name}, {"flat_yield", c.flat_yield}, {"yields", c.yields}});
  return json;
}

ModelParameters read(const JsonValue& value) {
  SlopeModelParameters p;
  p.form = form_of(value.require("form"));
  p.table_step_deg = value.require("table_step_deg").number();
  p.facet = facet_of(value.require("facet"));
  value.require("channels");
  for (const JsonValue& item : value.items("channels")) {
    SlopeChannel c;
    c.name = item.require("name").text();
    c.flat_yield = item.require("flat_yield").number();
    item.require("yields");
    c.yields = item.numbers("yields");
    p.channels.push_back(std::move(c));
  }
  return p;
}

}  // namespace

const ModelKind slope_model_kind{"slope", holds<SlopeModelParameters>, write, read};

}  // namespace surf::io
