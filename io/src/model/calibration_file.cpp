// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/model/calibration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "files/json_text.h"
#include "files/json_value.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr int version = 1;
constexpr std::size_t most_bytes = std::size_t{16} << 20;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr CalibrationOutcome outcomes[] = {
    CalibrationOutcome::trusted, CalibrationOutcome::doubtful, CalibrationOutcome::undetermined};

/// Infinity has no number in JSON.
void add_finite(Json& object, const char* key, double value) {
  if (std::isfinite(value)) object[key] = value;
}

CalibrationOutcome outcome_of(const JsonValue& value) {
  const std::string text = value.text();
  for (const CalibrationOutcome outcome : outcomes)
    if (text == name(outcome)) return outcome;
  value.fail(fmt::format("'{}' is no outcome", text));
}

}  // namespace

const char* name(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::trusted:
      return "trusted";
    case CalibrationOutcome::doubtful:
      return "doubtful";
    case CalibrationOutcome::undetermined:
      break;
  }
  return "undetermined";
}

void write_calibration(const std::filesystem::path& path, const CalibrationFile& file) {
  const Calibration& c = file.calibration;
  Json channels = Json::array();
  for (std::size_t i = 0; i < c.channels.size(); ++i) {
    channels.push_back({{"name", c.channels[i]}, {"gain", c.gains[i]}});
    add_finite(channels.back(), "stderr", c.gain_stderr(i));
  }
  Json offset = {{"value", c.offset}};
  add_finite(offset, "stderr", c.offset_stderr());
  Json json = {{"semsurf", "calibration"},
               {"version", version},
               {"outcome", name(c.outcome)},
               {"channels", channels},
               {"offset", offset}};
  if (c.outcome != CalibrationOutcome::undetermined) json["covariance"] = c.covariance;
  add_finite(json, "condition_number", c.condition_number);
  json["residual_rms"] = c.residual_rms;
  json["explained"] = c.explained;
  json["residual_correlation"] = c.residual_correlation;
  json["pixels"] = c.pixels;
  json["saturated"] = c.saturated;
  if (file.range_nm > 0) json["range_nm"] = file.range_nm;
  json["warnings"] = c.warnings;
  json["notes"] = file.notes;
  write_text(path, json_text(json));
}

CalibrationFile read_calibration(const std::filesystem::path& path) {
  const JsonValue json = JsonValue::parse(path.string(), read_file(path, most_bytes));
  if (json.text("semsurf", "") != "calibration")
    json.fail("it is no calibration", "Make one with 'semsurf calibrate'");
  if (json.require("version").whole() != version)
    json.fail("it is of another version", "Calibrate again with this semsurf");
  CalibrationFile file;
  Calibration& c = file.calibration;
  c.outcome = outcome_of(json.require("outcome"));
  for (const JsonValue& channel : json.items("channels")) {
    c.channels.push_back(channel.require("name").text());
    c.gains.push_back(channel.require("gain").number());
  }
  const std::size_t n = c.channels.size() + 1;
  if (n < 2) json.fail("it has no channels");
  c.offset = json.require("offset").require("value").number();
  if (c.outcome == CalibrationOutcome::undetermined) {
    c.covariance.assign(n * n, 0);
    for (std::size_t i = 0; i + 1 < n; ++i) c.covariance[i * (n + 1)] = infinity;
    const auto known = json.require("offset").find("stderr");
    c.covariance.back() = known ? known->number() * known->number() : infinity;
  } else {
    c.covariance = json.numbers("covariance");
    if (c.covariance.size() != n * n)
      json.require("covariance")
          .fail(fmt::format("{} numbers, not {} x {}", c.covariance.size(), n, n));
  }
  const auto condition = json.find("condition_number");
  c.condition_number = condition ? condition->number() : infinity;
  c.residual_rms = json.require("residual_rms").number();
  c.explained = json.require("explained").number();
  c.residual_correlation = json.require("residual_correlation").number();
  c.pixels = static_cast<std::int64_t>(json.require("pixels").whole());
  c.saturated = static_cast<std::int64_t>(json.whole("saturated", 0));
  if (const auto range = json.find("range_nm")) file.range_nm = range->number();
  for (const JsonValue& warning : json.items("warnings")) c.warnings.push_back(warning.text());
  file.notes = json.texts("notes");
  return file;
}

}  // namespace surf::io
