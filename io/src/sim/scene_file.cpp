// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim/material_tables.h"
#include "sim/read_described.h"
#include "sim/scene_parts.h"
#include "sim/toml_table.h"
#include "surf/io/files.h"
#include "surf/io/overlaps.h"
#include "surf/io/sim/scene_keys.h"
#include "surf/mc/sampling/choose_method.h"

namespace surf::io {
namespace {

constexpr std::size_t max_scene_bytes = std::size_t{16} << 20;

void read_materials(const TomlTable& root, const std::filesystem::path& path,
                    const std::vector<std::filesystem::path>& files, SceneFile& scene) {
  for (mc::Material& material :
       read_material_tables(root, builtin_materials(), reader_beside(path))) {
    scene.materials.add(std::move(material), path.string(), scene.notes);
  }
  for (const std::filesystem::path& file : files) scene.materials.read(file, scene.notes);
}

void read_specimen(const TomlTable& root, SceneParts parts, mc::Specimen& specimen) {
  if (const auto table = root.table("substrate")) specimen.substrate = parts.read_substrate(*table);
  if (const auto table = root.table("height_field")) {
    specimen.height_field = parts.read_height_field(*table);
  }
  for (const TomlTable& table : root.tables("body")) {
    for (mc::Body& body : parts.read_bodies(table)) specimen.bodies.push_back(std::move(body));
  }
  if (!specimen.substrate && !specimen.height_field && specimen.bodies.empty()) {
    throw FileError(root.place(), "there is nothing to look at",
                    "Add [substrate], [height_field] or [[body]]");
  }
}

}  // namespace

SceneFile read_scene(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& material_files,
                     const BodyReader& read) {
  const TomlTable root = TomlTable::parse(read_file(path, max_scene_bytes), path.string());
  std::vector<std::string> top;
  for (const SceneKey& key : top_scene_keys()) top.push_back(key.name);
  root.allow(top);
  SceneFile scene;
  scene.inputs.push_back(path);
  scene.title = root.text("title").value_or("");
  read_described(root, static_cast<mc::SimulationRequest&>(scene));
  if (const auto table = root.table("simulation"); table && table->has("cutoff"))
    at_place(*table, "cutoff", [&] { mc::validate(scene.physics); });
  read_materials(root, path, material_files, scene);
  read_specimen(root, SceneParts(path.parent_path(), scene, read), scene.specimen);
  scene.inputs.insert(scene.inputs.end(), material_files.begin(), material_files.end());
  return scene;
}

std::vector<std::filesystem::path> scene_input_files(const std::filesystem::path& path) {
  const TomlTable root = TomlTable::parse(read_file(path, max_scene_bytes), path.string());
  std::vector<std::filesystem::path> files{path};
  const auto add = [&](const TomlTable& table, std::string_view key) {
    if (!table.has(key)) return;
    for (auto& file : files_read_with(path.parent_path() / *table.text(key)))
      files.push_back(std::move(file));
  };
  if (const auto field = root.table("height_field")) add(*field, "file");
  for (const TomlTable& body : root.tables("body")) add(body, "mesh");
  return files;
}

bool is_scene_file(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".toml";
}

}  // namespace surf::io
