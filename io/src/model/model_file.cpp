// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/model/model_file.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "files/json_text.h"
#include "files/lower_extension.h"
#include "model/model_kinds.h"
#include "model/training_record_json.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

constexpr const char* format_name = "semsurf image model";
constexpr std::uint64_t version = 1;
constexpr std::size_t max_bytes = std::size_t{256} << 20;

constexpr const ModelKind* kinds[] = {&facet_network_kind, &filter_bank_kind, &slope_model_kind,
                                      &stopping_point_kind, &diffusion_matrix_kind};

const ModelKind& kind_for(const ModelParameters& parameters) {
  for (const ModelKind* kind : kinds)
    if (kind->is(parameters)) return *kind;
  throw Unsupported("model", "files cannot hold its kind", "Write a facet network");
}

const ModelKind& kind_for(const JsonValue& value) {
  const std::string name = value.text();
  std::string known;
  for (const ModelKind* kind : kinds) {
    if (name == kind->name) return *kind;
    known += fmt::format("{}'{}'", known.empty() ? "" : ", ", kind->name);
  }
  value.fail(fmt::format("there is no kind of model '{}'", name),
             fmt::format("Known are {}; a newer semsurf may know it", known));
}

void check_head(const JsonValue& root) {
  const std::string format = root.text("format", "");
  if (format != format_name)
    root.fail(fmt::format("it is no model: its format is '{}'", format),
              "Give a file that 'semsurf train' wrote");
  const std::uint64_t found = root.require("version").whole();
  if (found > version)
    root.require("version").fail(
        fmt::format("the file is of version {}, this semsurf reads {}", found, version),
        "Use a newer semsurf, or train the model again");
}

nlohmann::ordered_json scope_json(const ModelScope& scope) {
  return {{"pixel_nm", scope.pixel_nm},
          {"material", scope.material},
          {"energy_ev", scope.energy_ev},
          {"spot_nm", scope.spot_nm}};
}

double not_negative(const JsonValue& scope, const char* key) {
  const JsonValue value = scope.require(key);
  const double number = value.number();
  if (number < 0) value.fail("it is negative");
  return number;
}

ModelScope scope_of(const JsonValue& value) {
  return {not_negative(value, "pixel_nm"), value.require("material").text(),
          not_negative(value, "energy_ev"), not_negative(value, "spot_nm")};
}

}  // namespace

TrainedModel read_model(const std::filesystem::path& path) {
  const JsonValue root = JsonValue::parse(path.string(), read_file(path, max_bytes));
  check_head(root);
  TrainedModel model;
  model.scope = scope_of(root.require("scope"));
  const JsonValue parameters = root.require("parameters");
  model.parameters = kind_for(root.require("kind")).read(parameters);
  model.record = record_of(root.require("training"));
  try {
    make_model(model);
  } catch (const InvalidInput& error) {
    parameters.fail(fmt::format("{}: {}", error.subject(), error.reason()), error.remedy());
  }
  return model;
}

void write_model(const std::filesystem::path& path, const TrainedModel& model) {
  check_model_target(path);
  const ModelKind& kind = kind_for(model.parameters);
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["format"] = format_name;
  json["version"] = version;
  json["kind"] = kind.name;
  json["scope"] = scope_json(model.scope);
  json["training"] = record_json(model.record);
  json["parameters"] = kind.write(model.parameters);
  write_text(path, json_text(json));
}

void check_model_target(const std::filesystem::path& path) {
  if (lower_extension(path) != ".json")
    throw UsageError("`output`", fmt::format("{} does not end in .json", path.string()),
                     "Add `output=model.json`");
  check_writable(path);
}

bool is_model_file(const std::filesystem::path& path) {
  std::error_code error;
  if (lower_extension(path) != ".json" || !std::filesystem::is_regular_file(path, error))
    return false;
  std::ifstream in(path, std::ios::binary);
  std::string head(4096, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head.find(format_name) != std::string::npos;
}

std::string kind_of(const TrainedModel& model) { return kind_for(model.parameters).name; }

}  // namespace surf::io
