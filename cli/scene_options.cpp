// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/mesh_bodies.h"

namespace surf::cli {
namespace {

namespace fs = std::filesystem;

int material_index(io::SceneFile& scene, const std::string& name, const std::string& subject) {
  const mc::Material& material = scene.materials.find(name, subject);
  auto& all = scene.specimen.materials;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const mc::Material& m) { return m.name == material.name; });
  if (found != all.end()) return static_cast<int>(found - all.begin());
  all.push_back(material);
  return static_cast<int>(all.size()) - 1;
}

const Channel& height_channel(const Image& image, const fs::path& path, const std::string& wanted,
                              std::vector<std::string>& notes) {
  if (!wanted.empty()) {
    if (const Channel* channel = image.find(wanted)) return *channel;
    throw UsageError("--height-channel", fmt::format("{} has no channel '{}'", path.string(), wanted),
                     "'semsurf info' lists its channels");
  }
  for (const char* name : {"z_nm", "z"})
    if (const Channel* channel = image.find(name)) return *channel;
  const Channel& first = image.channels.front();
  if (image.channels.size() > 1)
    notes.push_back(fmt::format("{}: heights are taken from its first channel, {}", path.string(),
                                first.name));
  return first;
}

struct FieldUnits {
  std::optional<std::pair<double, double>> pitch_nm;
  std::optional<double> z_nm;
};

FieldUnits parse_units(const SceneOptions& options) {
  FieldUnits units;
  if (options.pitch) {
    units.pitch_nm = parse_pixel_size(*options.pitch, "--pitch");
    if (!(units.pitch_nm->first > 0) || !(units.pitch_nm->second > 0))
      throw UsageError("--pitch", "it must be above zero", "Write --pitch 2nm");
  }
  if (options.z_unit) {
    units.z_nm = parse_length_nm(*options.z_unit, "--z-unit");
    if (!(*units.z_nm > 0))
      throw UsageError("--z-unit", "it must be above zero", "Write --z-unit 0.1nm");
  }
  return units;
}

HeightField read_scan_field(const fs::path& path, const SceneOptions& options, const FieldUnits& units,
                            std::vector<std::string>& notes) {
  io::HeightReadOptions read;
  read.channel = options.height_channel.value_or("");
  read.z_unit_nm = units.z_nm;
  if (units.pitch_nm) std::tie(read.pitch_x_nm, read.pitch_y_nm) = *units.pitch_nm;
  io::HeightFieldFile file = io::read_height_field(path, read);
  for (const std::string& note : file.notes) notes.push_back(fmt::format("{}: {}", path.string(), note));
  return std::move(file.field);
}

HeightField read_image_field(const fs::path& path, const SceneOptions& options, const FieldUnits& units,
                             std::vector<std::string>& notes) {
  if (!units.z_nm) io::refuse_as_heights(path);
  const Image image = io::read_image(path);
  const Channel& channel = height_channel(image, path, options.height_channel.value_or(""), notes);
  return io::to_height_field(image, channel.name, units.z_nm.value_or(1));
}

HeightField read_height_field(const fs::path& path, const SceneOptions& options,
                              std::vector<std::string>& notes) {
  const FieldUnits units = parse_units(options);
  HeightField field = io::is_height_field_file(path) ? read_scan_field(path, options, units, notes)
                                                     : read_image_field(path, options, units, notes);
  if (!units.pitch_nm) return field;
  std::tie(field.pitch_x_nm, field.pitch_y_nm) = *units.pitch_nm;
  field.origin_x_nm = -0.5 * field.pitch_x_nm * (field.z_nm.width() - 1);   // as scene files do
  field.origin_y_nm = -0.5 * field.pitch_y_nm * (field.z_nm.height() - 1);
  return field;
}

// All bodies of a mesh file; materials that its bodies name and semsurf knows are taken as such.
void add_mesh_bodies(const std::string& input, const io::MeshUnit& unit,
                     const std::string& fallback, const io::BodyReader& read, io::SceneFile& scene,
                     std::vector<std::string>& notes) {
  std::vector<io::MeshBody> bodies =
      read(input, unit, {fallback, {}, "--material"}, scene.materials);
  for (io::MeshBody& body : bodies) {
    const std::string name = bodies.size() == 1 ? input : input + ", " + body.name;
    if (body.is_default && !body.file_material.empty())
      notes.push_back(fmt::format("{}: '{}' is no known material: {}", name, body.file_material,
                                  fallback));
    const int material = material_index(scene, body.material, "--material");
    scene.specimen.bodies.push_back({name, std::move(body.mesh), material});
    scene.unit_assumed = scene.unit_assumed || body.unit_assumed;
  }
}

io::SceneFile scene_from_shapes(const SceneOptions& options, const io::BodyReader& read,
                                std::vector<std::string>& notes) {
  io::SceneFile scene;
  for (const std::string& file : options.materials) {
    scene.materials.read(file, scene.notes);
    scene.inputs.push_back(file);
  }
  const std::string material = options.material.value_or("Si");
  if (!options.material) notes.push_back("no --material is given: Si");
  const io::MeshUnit unit = parse_mesh_unit(options.unit, options.override_unit);
  for (const std::string& input : options.inputs) {
    const fs::path path(input);
    if (io::is_scene_file(path))
      throw UsageError(input, "a scene file cannot be combined with other inputs",
                       "Add the others to the scene file");
    if (io::is_image_file(path) || io::is_height_field_file(path)) {
      if (scene.specimen.height_field)
        throw UsageError(input, "there is a height field already", "Give one image at most");
      scene.specimen.height_field = mc::HeightFieldBody{
          input, read_height_field(path, options, notes),
          material_index(scene, material, "--material"), Edge::mirror};
      scene.inputs.push_back(path);
    } else {
      add_mesh_bodies(input, unit, material, read, scene, notes);
      if (unit.overrides_file) scene.unit_overrides.push_back({path.filename().string(), *unit.nm});
      for (auto& file : io::mesh_input_files(path)) scene.inputs.push_back(std::move(file));
    }
  }
  const bool has_field = scene.specimen.height_field.has_value();
  if (!has_field && (options.pitch || options.z_unit || options.height_channel))
    throw UsageError(options.pitch ? "--pitch" : options.z_unit ? "--z-unit" : "--height-channel",
                     "no input is a height field",
                     "Leave it out, or give an image");
  if (scene.specimen.bodies.empty() && options.unit)
    throw UsageError("--unit", "no input is a mesh", "Leave it out; --z-unit scales heights");
  return scene;
}

io::SceneFile scene_from_file(const SceneOptions& options, const io::BodyReader& read) {
  const auto refuse = [](const std::optional<std::string>& value, const char* option) {
    if (value)
      throw UsageError(option, "a scene file says this for each of its parts",
                       "Change the scene file, or give a mesh");
  };
  refuse(options.material, "--material");
  refuse(options.unit, "--unit");
  if (options.override_unit)
    throw UsageError("--override-unit", "a scene file says this for each of its parts", "Write override_unit = true there");
  refuse(options.pitch, "--pitch");
  refuse(options.z_unit, "--z-unit");
  refuse(options.height_channel, "--height-channel");
  return io::read_scene(options.inputs.front(),
                        {options.materials.begin(), options.materials.end()}, read);
}

void apply_specimen(const SceneOptions& options, io::SceneFile& scene) {
  mc::Specimen& specimen = scene.specimen;
  if (options.substrate) {
    if (!specimen.substrate) specimen.substrate.emplace();
    specimen.substrate->material = material_index(scene, *options.substrate, "--substrate");
  }
  if (options.substrate_z) {
    if (!specimen.substrate)
      throw UsageError("--substrate-z", "there is no substrate", "Add --substrate Si");
    specimen.substrate->top_nm = parse_length_nm(*options.substrate_z, "--substrate-z");
  }
  if (options.edge) {
    const Edge edge = parse_edge(*options.edge, "--edge");
    if (!specimen.height_field)
      throw UsageError("--edge", "the specimen has no height field", "Leave it out");
    specimen.height_field->edge = edge;
  }
}

void apply_beam(const SceneOptions& options, mc::Beam& beam) {
  if (options.energy) beam.energy_ev = parse_energy_ev(*options.energy, "--energy");
  if (options.tilt) beam.tilt_deg = parse_angle_deg(*options.tilt, "--tilt");
  if (options.azimuth) beam.azimuth_deg = parse_angle_deg(*options.azimuth, "--azimuth");
  if (options.spot) beam.spot_nm = parse_length_nm(*options.spot, "--spot");
  if (options.convergence)
    beam.convergence_deg = parse_angle_deg(*options.convergence, "--convergence");
  if (options.focus) beam.focus_nm = parse_length_nm(*options.focus, "--focus");
  if (options.working_distance) {
    beam.working_distance_nm = parse_length_nm(*options.working_distance, "--working-distance");
    if (beam.working_distance_nm == 0)
      throw UsageError("--working-distance", "it must be above zero",
                       "Give a length, such as 5mm, or leave it out for parallel beams");
  }
}

void apply_dose(const SceneOptions& options, io::SceneFile& scene) {
  if (!options.current && !options.dwell) return;
  if (options.current) scene.current_pa = parse_current_pa(*options.current, "--current");
  if (options.dwell) scene.dwell_us = parse_time_us(*options.dwell, "--dwell");
  scene.electrons.reset();   // what the scene file says: the command line goes before it
}

void add_detectors(const SceneOptions& options, io::SceneFile& scene) {
  for (const std::string& text : options.detectors)
    for (mc::Detector& d : mc::parse_detectors(text, "--detector"))
      scene.detectors.push_back(std::move(d));
}

// What the command line gives replaces the same thing in the scene file. Where that leaves size,
// pixel size and region, the one of the file that least changes the picture gives way.
void apply_scan(const SceneOptions& options, mc::ScanRequest& scan) {
  const int given = options.size.has_value() + options.pixel_size.has_value() +
                    options.region.has_value();
  if (given == 2) scan = {};
  if (options.size)
    std::tie(scan.width, scan.height) = parse_size(*options.size, "--size");
  if (options.pixel_size)
    std::tie(scan.pixel_x_nm, scan.pixel_y_nm) =
        parse_pixel_size(*options.pixel_size, "--pixel-size");
  if (options.region) scan.region = parse_region(*options.region, "--region");
  if (given != 1 || !scan.width || !scan.pixel_x_nm || !scan.region) return;
  if (options.pixel_size)
    scan.width = scan.height = std::nullopt;
  else
    scan.pixel_x_nm = scan.pixel_y_nm = std::nullopt;
}

}  // namespace

io::SceneFile make_scene(const SceneOptions& options, std::vector<std::string>& notes,
                         const io::BodyReader& read) {
  if (options.inputs.empty())
    throw UsageError("simulate", "no specimen is given",
                     "Give a mesh, a height field or a scene file, as in 'semsurf simulate "
                     "cube.stl -o cube.exr'");
  const bool from_file = options.inputs.size() == 1 && io::is_scene_file(options.inputs.front());
  io::SceneFile scene =
      from_file ? scene_from_file(options, read) : scene_from_shapes(options, read, notes);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  apply_specimen(options, scene);
  apply_beam(options, scene.beam);
  apply_dose(options, scene);
  add_detectors(options, scene);
  apply_scan(options, scene.scan);
  if (options.physics) mc::parse_physics(*options.physics, scene.physics);
  if (options.cutoff) scene.physics.cutoff_ev = parse_energy_ev(*options.cutoff, "--cutoff");
  return scene;
}

}  // namespace surf::cli
