// SPDX-License-Identifier: GPL-3.0-or-later
// Targets that read scenes, materials, models, and the small files of registration.
#include "files/zip_file.h"
#include "memory_files.h"
#include "sim/toml_table.h"
#include "surf/core/error.h"
#include "surf/io/landmarks_file.h"
#include "surf/io/model/calibration_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/transform_file.h"
#include "surf/mesh/shapes.h"
#include "target_lists.h"

namespace surf::test {
namespace {

/// Shapes of many samples take long to make. That is no fault of the reader, and is left out.
void refuse_large_shapes(const std::string& content) {
  constexpr double most = 200;
  const auto field = io::TomlTable::parse(content, "scene.toml").table("height_field");
  if (!field || !field->has("shape")) return;
  const FieldExtent usual;
  const double pitch = field->length_nm("pitch").value_or(usual.pitch_nm),
               width = field->length_nm("width").value_or(usual.width_nm);
  for (const double side : {width, field->length_nm("depth").value_or(width),
                            field->length_nm("correlation").value_or(0)})
    if (side / pitch > most) throw InvalidInput("input", "its shape is large", "Try a smaller one");
}

Accepted scene(const std::string& content) {
  refuse_large_shapes(content);
  put_memory_file("scene.toml", content);
  io::read_scene("scene.toml");
  return {};
}

Accepted materials(const std::string& content) {
  put_memory_file("materials.toml", content);
  std::vector<std::string> notes;
  io::MaterialLibrary().read("materials.toml", notes);
  return {};
}

Accepted model(const std::string& content) {
  put_memory_file("model.json", content);
  Accepted accepted;
  accepted.model = io::read_model("model.json");
  return accepted;
}

Accepted calibration(const std::string& content) {
  put_memory_file("calibration.json", content);
  io::read_calibration("calibration.json");
  return {};
}

Accepted transform(const std::string& content) {
  put_memory_file("transform.json", content);
  io::read_transform("transform.json");
  return {};
}

Accepted landmarks(const std::string& content) {
  put_memory_file("landmarks.csv", content);
  PlacedImage image;
  image.values = Grid<double>(8, 8);
  io::read_landmarks("landmarks.csv", image, image);
  return {};
}

Accepted archive(const std::string& content) {
  const io::ZipReader zip("archive", content);
  for (const std::string& name : zip.names()) zip.read(name);
  return {};
}

}  // namespace

std::vector<FuzzTarget> text_targets() {
  return {{"toml", scene, mutate_text},          {"materials", materials, mutate_text},
          {"json", model, mutate_json},          {"calibration", calibration, mutate_json},
          {"transform", transform, mutate_json}, {"landmarks", landmarks, mutate_text},
          {"zip", archive, mutate_zip}};
}

}  // namespace surf::test
