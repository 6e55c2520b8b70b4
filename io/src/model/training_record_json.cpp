// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/training_record_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace surf::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* infinite = "infinite";  // JSON has no number for it

Json residuals_json(const std::vector<ModelResidual>& residuals) {
  Json json = Json::array();
  for (const ModelResidual& r : residuals)
    json.push_back({{"channel", r.channel},
                    {"rms", r.rms},
                    {"noise_rms", r.noise_rms},
                    {"mean_relative", r.mean_relative},
                    {"mean_signal", r.mean_signal},
                    {"pixels", r.pixels}});
  return json;
}

std::vector<ModelResidual> residuals_of(const JsonValue& value, const char* key) {
  std::vector<ModelResidual> residuals;
  for (const JsonValue& item : value.items(key))
    residuals.push_back({item.require("channel").text(), item.require("rms").number(),
                         item.require("noise_rms").number(), item.require("mean_relative").number(),
                         item.require("mean_signal").number(),
                         static_cast<std::int64_t>(item.require("pixels").whole())});
  return residuals;
}

Json scene_json(const TrainingScene& scene) {
  return {{"name", scene.name},
          {"sha256", scene.sha256},
          {"width", scene.width},
          {"height", scene.height},
          {"electrons", scene.electrons},
          {"held_out", scene.held_out},
          {"residuals", residuals_json(scene.residuals)}};
}

int size_of(const JsonValue& value) {
  const std::uint64_t size = value.whole();
  if (size > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    value.fail("it is too large");
  return static_cast<int>(size);
}

TrainingScene scene_of(const JsonValue& value) {
  TrainingScene scene;
  scene.name = value.require("name").text();
  scene.sha256 = value.text("sha256", "");
  scene.width = size_of(value.require("width"));
  scene.height = size_of(value.require("height"));
  scene.electrons = static_cast<std::int64_t>(value.whole("electrons", 0));
  scene.held_out = value.boolean("held_out", false);
  scene.residuals = residuals_of(value, "residuals");
  return scene;
}

Json range_json(const SurfaceRange& range) {
  return {{"slope_deg_p99", range.slope_deg_p99},
          {"slope_deg_max", range.slope_deg_max},
          {"curvature_p99_per_nm", range.curvature_p99_per_nm},
          {"curvature_max_per_nm", range.curvature_max_per_nm}};
}

SurfaceRange range_of(const JsonValue& value) {
  return {value.require("slope_deg_p99").number(), value.require("slope_deg_max").number(),
          value.require("curvature_p99_per_nm").number(),
          value.require("curvature_max_per_nm").number()};
}

double condition_of(const JsonValue& record) {
  const JsonValue value = record.require("condition_number");
  if (value.is_text() && value.text() == infinite) return HUGE_VAL;
  return value.number();
}

std::vector<std::string> warnings_of(const JsonValue& record) {
  std::vector<std::string> warnings;
  for (const JsonValue& warning : record.items("warnings")) warnings.push_back(warning.text());
  return warnings;
}

}  // namespace

Json record_json(const TrainingRecord& record) {
  Json json = Json::object();
  if (std::isinf(record.condition_number)) json["condition_number"] = infinite;
  else json["condition_number"] = record.condition_number;
  json["residuals"] = residuals_json(record.residuals);
  json["held_out_residuals"] = residuals_json(record.held_out_residuals);
  json["surfaces"] = range_json(record.range);
  json["warnings"] = record.warnings;
  json["notes"] = Json::object();
  for (const auto& [key, value] : record.notes) json["notes"][key] = value;
  json["scenes"] = Json::array();
  for (const TrainingScene& scene : record.scenes) json["scenes"].push_back(scene_json(scene));
  return json;
}

TrainingRecord record_of(const JsonValue& value) {
  TrainingRecord record;
  record.condition_number = condition_of(value);
  value.require("residuals");
  record.residuals = residuals_of(value, "residuals");
  record.held_out_residuals = residuals_of(value, "held_out_residuals");
  record.range = range_of(value.require("surfaces"));
  record.warnings = warnings_of(value);
  record.notes = value.texts("notes");
  value.require("scenes");
  for (const JsonValue& scene : value.items("scenes")) record.scenes.push_back(scene_of(scene));
  return record;
}

}  // namespace surf::io
