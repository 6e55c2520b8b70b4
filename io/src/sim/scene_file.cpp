// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim/material_tables.h"
#include "sim/scene_parts.h"
#include "sim/toml_table.h"
#include "surf/io/files.h"
#include "surf/io/overlaps.h"
#include "surf/mc/choose_method.h"

namespace surf::io {
namespace {

constexpr std::size_t max_scene_bytes = std::size_t{16} << 20;

mc::Beam read_beam(const TomlTable& table) {
  table.allow({"energy", "tilt", "azimuth", "spot", "convergence", "focus", "working_distance",
               "current", "dwell"});
  mc::Beam beam;
  beam.energy_ev = table.energy_ev("energy").value_or(beam.energy_ev);
  beam.tilt_deg = table.angle_deg("tilt").value_or(beam.tilt_deg);
  beam.azimuth_deg = table.angle_deg("azimuth").value_or(beam.azimuth_deg);
  beam.spot_nm = table.length_nm("spot").value_or(beam.spot_nm);
  beam.convergence_deg = table.angle_deg("convergence").value_or(beam.convergence_deg);
  beam.focus_nm = table.length_nm("focus").value_or(beam.focus_nm);
  beam.working_distance_nm = table.length_nm("working_distance").value_or(0);
  at_place(table, {}, [&] { mc::validate(beam); });
  return beam;
}

void read_dose(const TomlTable& table, SceneFile& scene) {
  scene.current_pa = table.current_pa("current");
  scene.dwell_us = table.time_us("dwell");
}

/// One value for both axes or one for each.
std::optional<std::pair<double, double>> read_pair(const TomlTable& table, std::string_view key,
                                                   const char* example) {
  const auto values = table.lengths_nm(key, "x");
  if (!values) return {};
  if (values->empty() || values->size() > 2) {
    throw UsageError(table.place(key), fmt::format("{} values are given", values->size()),
                     fmt::format("Write one or two, such as {}", example));
  }
  if (!(values->front() > 0 && values->back() > 0)) {
    throw UsageError(table.place(key), "the value is not above 0",
                     fmt::format("Write for example {}", example));
  }
  return std::pair(values->front(), values->back());
}

int pixel_count(double value, const std::string& place) {
  if (value != std::floor(value) || value > static_cast<double>(mc::max_pixels)) {
    throw UsageError(place, fmt::format("{} is not a number of pixels", value),
                     "Write for example \"256x256\"");
  }
  return static_cast<int>(value);
}

void refuse_units(const TomlTable& table, std::string_view key) {
  if (!table.is_text(key)) return;
  if (table.text(key)->find_first_not_of("0123456789x ") == std::string::npos) return;
  throw UsageError(table.place(key), "it is not a number of pixels",
                   "Write for example \"256x256\", or use pixel_size or region for lengths");
}

ScanRequest read_scan(const TomlTable& table) {
  table.allow({"size", "pixel_size", "region"});
  ScanRequest scan;
  refuse_units(table, "size");
  if (const auto size = read_pair(table, "size", "\"256x256\"")) {
    scan.width = pixel_count(size->first, table.place("size"));
    scan.height = pixel_count(size->second, table.place("size"));
  }
  if (const auto pixel = read_pair(table, "pixel_size", "\"1nm\"")) {
    scan.pixel_x_nm = pixel->first;
    scan.pixel_y_nm = pixel->second;
  }
  if (const auto region = table.lengths_nm("region")) {
    if (region->size() != 4) {
      throw UsageError(table.place("region"), fmt::format("{} numbers are given", region->size()),
                       "Write four: X0, Y0, X1, Y1");
    }
    const auto& r = *region;
    scan.region = {r[0], r[1], r[2], r[3]};
    if (!(r[2] > r[0] && r[3] > r[1])) {
      throw UsageError(table.place("region"), "it is empty", "Write X0 < X1 and Y0 < Y1");
    }
  }
  return scan;
}

void read_accuracy(const TomlTable& table, SceneFile& scene) {
  scene.accuracy = table.share("accuracy");
  scene.accuracy_floor = table.number("accuracy_floor");
  if (scene.accuracy && !(*scene.accuracy >= 1e-4 && *scene.accuracy <= 1))
    throw UsageError(table.place("accuracy"), "it is outside 0.01% to 100%",
                     "Write for example \"1%\"");
  if (scene.accuracy && scene.electrons)
    throw UsageError(table.place("accuracy"), "electrons are given as well",
                     "Leave one of the two out");
  if (scene.accuracy_floor && !scene.accuracy)
    throw UsageError(table.place("accuracy_floor"), "there is no accuracy",
                     "Add accuracy = \"1%\", or leave it out");
  if (scene.accuracy_floor && !(*scene.accuracy_floor >= 0))
    throw UsageError(table.place("accuracy_floor"), "it is negative",
                     "Give electrons per primary, such as 0.002, or 0");
}

void read_simulation(const TomlTable& table, SceneFile& scene) {
  table.allow({"electrons", "method", "accuracy", "accuracy_floor", "mesh_tolerance", "seed",
               "physics", "cutoff", "detectors"});
  if (const auto method = table.text("method"))
    scene.method = mc::parse_method(*method, table.place("method"));
  if (const auto electrons = table.integer("electrons")) {
    if (*electrons < 1) {
      throw UsageError(table.place("electrons"), fmt::format("it is {}", *electrons),
                       "Give one or more primaries per pixel");
    }
    scene.electrons = electrons;
  }
  read_accuracy(table, scene);
  scene.mesh_tolerance_nm = table.length_nm("mesh_tolerance");
  if (scene.mesh_tolerance_nm && !(*scene.mesh_tolerance_nm >= 0))
    throw UsageError(table.place("mesh_tolerance"), "it is negative",
                     "Give 0 or a length such as \"0.5nm\"");
  if (const auto seed = table.integer("seed")) {
    if (*seed < 0) {
      throw UsageError(table.place("seed"), "it is negative", "Give a whole number, 0 or above");
    }
    scene.seed = static_cast<std::uint64_t>(*seed);
  }
  if (const auto physics = table.text("physics")) {
    at_place(table, "physics", [&] { mc::parse_physics(*physics, scene.physics); });
  }
  for (const std::string& text : table.texts("detectors"))
    at_place(table, "detectors", [&] {
      for (mc::Detector& d : mc::parse_detectors(text, "detectors"))
        scene.detectors.push_back(std::move(d));
    });
  if (const auto cutoff = table.energy_ev("cutoff")) {
    scene.physics.cutoff_ev = *cutoff;
    at_place(table, "cutoff", [&] { mc::validate(scene.physics); });
  }
}

void read_materials(const TomlTable& root, const std::filesystem::path& path,
                    const std::vector<std::filesystem::path>& files, SceneFile& scene) {
  for (mc::Material& material : read_material_tables(root, builtin_materials())) {
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
  root.allow({"title", "beam", "scan", "simulation", "substrate", "height_field", "body",
              "material"});
  SceneFile scene;
  scene.inputs.push_back(path);
  scene.title = root.text("title").value_or("");
  if (const auto table = root.table("beam")) {
    scene.beam = read_beam(*table);
    read_dose(*table, scene);
  }
  if (const auto table = root.table("scan")) scene.scan = read_scan(*table);
  if (const auto table = root.table("simulation")) read_simulation(*table, scene);
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
    for (auto& file : files_read_with(path.parent_path() / *table.text(key))) files.push_back(std::move(file));
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
