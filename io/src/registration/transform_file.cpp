// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/transform_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "files/json_text.h"
#include "files/json_value.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr int version = 1;

}  // namespace

void write_transform(const std::filesystem::path& path, const TransformFile& file) {
  const Affine& m = file.sem_to_afm;
  Json json = {{"semsurf", "transform"}, {"version", version}};
  json["sem_to_afm"] = {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0};
  json["verified"] = file.verified;
  if (!file.verdict.empty()) json["verdict"] = file.verdict;
  json["notes"] = file.notes;
  write_text(path, json_text(json));
}

TransformFile read_transform(const std::filesystem::path& path) {
  const JsonValue json = JsonValue::parse(path.string(), read_file(path, std::size_t{1} << 24));
  if (json.text("semsurf", "") != "transform")
    json.fail("it is no transform", "Make one with 'semsurf register -o transform.json'");
  if (json.require("version").whole() != version)
    json.fail("it is of another version", "Register again with this semsurf");
  const std::vector<double> numbers = json.numbers("sem_to_afm");
  if (numbers.size() != 6)
    json.require("sem_to_afm")
        .fail(fmt::format("{} numbers, not 6", numbers.size()), "Give xx, xy, x0, yx, yy, y0");
  TransformFile file;
  file.sem_to_afm = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
  try {
    inverse(file.sem_to_afm);
  } catch (const InvalidInput& error) {
    json.require("sem_to_afm").fail(error.reason(), error.remedy());
  }
  file.verified = json.boolean("verified", true);
  file.verdict = json.text("verdict", "");
  file.notes = json.texts("notes");
  return file;
}

}  // namespace surf::io
