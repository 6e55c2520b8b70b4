// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/specimen_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "sim/add_material.h"
#include "sim/field_source.h"
#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/specimen_in_memory.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::optional<double>& nm) {
  return nm ? format_exact(*nm) + "nm" : std::string();
}

/// All bodies of a mesh file; materials that its bodies name and semsurf knows are taken as such.
void add_mesh_bodies(const std::string& input, const SpecimenRequest& request,
                     const std::string& fallback, const BodyReader& read, SceneFile& scene) {
  const MeshUnit unit{request.mesh_unit_nm, request.override_unit};
  std::vector<MeshBody> bodies =
      read(input, unit, {fallback, {}, "`specimen.material`"}, scene.materials);
  for (MeshBody& body : bodies) {
    const std::string name = bodies.size() == 1 ? input : input + ", " + body.name;
    if (body.is_default && !body.file_material.empty())
      scene.notes.push_back(
          fmt::format("{}: '{}' is no known material: {}", name, body.file_material, fallback));
    const int material = add_material(scene, body.material, "`specimen.material`");
    scene.specimen.bodies.push_back({name, std::move(body.mesh), material});
    scene.unit_assumed = scene.unit_assumed || body.unit_assumed;
  }
  if (unit.overrides_file)
    scene.unit_overrides.push_back({fs::path(input).filename().string(), *unit.nm});
  for (auto& file : mesh_input_files(input)) scene.inputs.push_back(std::move(file));
}

/// Shapes in memory are called as they are named, or by what they are.
void add_shapes_in_memory(const ShapesInMemory& shapes, const std::string& fallback,
                          SceneFile& scene) {
  for (const NamedMesh& body : shapes.meshes) {
    const std::string& material = body.material.empty() ? fallback : body.material;
    scene.specimen.bodies.push_back({body.name.empty() ? "mesh" : body.name, body.mesh,
                                     add_material(scene, material, "`specimen.material`")});
  }
  if (!shapes.field) return;
  if (scene.specimen.height_field)
    throw UsageError("heights", "there is a height field already", "Give one at most");
  scene.specimen.height_field = mc::HeightFieldBody{
      "heights", *shapes.field, add_material(scene, fallback, "`specimen.material`"), Edge::mirror};
}

SceneFile from_shapes(const SpecimenRequest& request, const ShapesInMemory& shapes,
                      const BodyReader& read) {
  SceneFile scene;
  std::vector<std::string> of_materials;
  for (const std::string& file : request.material_files) {
    scene.materials.read(file, of_materials);
    scene.inputs.push_back(file);
  }
  const std::string material = request.material.value_or("Si");
  if (!request.material) scene.notes.push_back("no `specimen.material` is given: Si is assumed");
  if (request.override_unit && !request.mesh_unit_nm)
    throw UsageError("`specimen.override_unit`", "there is no unit to take in place of the file's",
                     "Add `specimen.unit=um`, or leave it out");
  for (const std::string& input : request.inputs) {
    const fs::path path(input);
    if (is_scene_file(path))
      throw UsageError(input, "a scene file cannot be combined with other inputs",
                       "Add the others to the scene file");
    if (!is_image_file(path) && !is_height_field_file(path)) {
      add_mesh_bodies(input, request, material, read, scene);
      continue;
    }
    if (scene.specimen.height_field)
      throw UsageError(input, "there is a height field already", "Give one image at most");
    HeightField field = read_field({path, request.heights}, input, scene.notes);
    scene.specimen.height_field =
        mc::HeightFieldBody{input, std::move(field),
                            add_material(scene, material, "`specimen.material`"), Edge::mirror};
    scene.inputs.push_back(path);
  }
  add_shapes_in_memory(shapes, material, scene);
  scene.notes.insert(scene.notes.end(), of_materials.begin(), of_materials.end());
  const char* const of_heights = request.heights.pitch_x_nm         ? "`scan.height_pitch`"
                                 : request.heights.z_unit_nm        ? "`scan.height_unit`"
                                 : !request.heights.channel.empty() ? "`scan.height_channel`"
                                                                    : nullptr;
  if (of_heights && !scene.specimen.height_field)
    throw UsageError(of_heights, "no input is a height field", "Leave it out, or give an image");
  if (scene.specimen.bodies.empty() && request.mesh_unit_nm)
    throw UsageError("`specimen.unit`", "no input is a mesh",
                     "Leave it out; `scan.height_unit` scales heights");
  return scene;
}

SceneFile from_file(const SpecimenRequest& request, const BodyReader& read) {
  for (const auto& [given, name] : {std::pair{request.material.has_value(), "`specimen.material`"},
                                    {request.mesh_unit_nm.has_value(), "`specimen.unit`"},
                                    {request.override_unit, "`specimen.override_unit`"},
                                    {request.heights.pitch_x_nm.has_value(), "`scan.height_pitch`"},
                                    {request.heights.z_unit_nm.has_value(), "`scan.height_unit`"},
                                    {!request.heights.channel.empty(), "`scan.height_channel`"}})
    if (given)
      throw UsageError(name, "a scene file says this for each of its parts",
                       "Change the scene file, or give a mesh");
  return read_scene(request.inputs.front(),
                    {request.material_files.begin(), request.material_files.end()}, read);
}

}  // namespace

void describe(ParameterVisitor& visit, SpecimenRequest& r) {
  visit(r.inputs, {.name = "specimen.input",
                   .help = "Meshes (STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM), a height field (an "
                           "AFM scan, EXR, TIFF, PNG, VTI) or "
                           "one scene file (TOML)",
                   .recorded = false,
                   .file = FileRole::read});
  visit(r.material, {.name = "specimen.material",
                     .help = "Material of meshes and height field",
                     .otherwise = "Si",
                     .form = "MATERIAL"});
  visit(r.material_files, {.name = "specimen.materials",
                           .help = "File of your own materials (TOML)",
                           .level = Level::advanced,
                           .recorded = false,
                           .file = FileRole::read});
  visit.form(
      {.name = "specimen.unit",
       .help = "Length of one unit of the mesh files",
       .otherwise = "as they say, else nm; glTF: m",
       .form = "nm|um|mm|m|pm|A|in"},
      [&] { return text_of(r.mesh_unit_nm); },
      [&](std::string_view text, const std::string& subject) {
        r.mesh_unit_nm = parse_unit_nm(text, subject);
      });
  visit(r.override_unit, {.name = "specimen.override_unit",
                          .help = "Take the given unit even where a mesh file says another",
                          .level = Level::advanced});
  visit(r.substrate, {.name = "specimen.substrate",
                      .help = "Material of a half-space below the bodies",
                      .otherwise = "none",
                      .form = "MATERIAL"});
  visit(r.substrate_z_nm, {.name = "specimen.substrate_z",
                           .help = "Height of the substrate's top",
                           .unit = Unit::nm,
                           .otherwise = format_value(mc::Substrate{}.top_nm, Unit::nm),
                           .level = Level::advanced});
  visit(r.edge, {"mirror", "flat", "periodic"},
        {.name = "specimen.edge",
         .help = "Continuation of a height field outside its samples",
         .otherwise = "mirror",
         .level = Level::advanced});
  describe(visit, r.heights);
}

SceneFile read_specimen(const SpecimenRequest& request, const BodyReader& read) {
  return read_specimen(request, ShapesInMemory{}, read);
}

SceneFile read_specimen(const SpecimenRequest& request, const ShapesInMemory& shapes,
                        const BodyReader& read) {
  const bool in_memory = !shapes.meshes.empty() || shapes.field;
  if (request.inputs.empty() && !in_memory)
    throw UsageError(
        "simulate", "no specimen is given",
        "Give a mesh, a height field or a scene file: 'semsurf simulate --help' has examples");
  const bool is_file =
      request.inputs.size() == 1 && !in_memory && is_scene_file(request.inputs.front());
  SceneFile scene = is_file ? from_file(request, read) : from_shapes(request, shapes, read);
  mc::Specimen& specimen = scene.specimen;
  if (request.substrate) {
    if (!specimen.substrate) specimen.substrate.emplace();
    specimen.substrate->material = add_material(scene, *request.substrate, "`specimen.substrate`");
  }
  if (request.substrate_z_nm) {
    if (!specimen.substrate)
      throw UsageError("`specimen.substrate_z`", "there is no substrate",
                       "Add `specimen.substrate=Si`");
    specimen.substrate->top_nm = *request.substrate_z_nm;
  }
  if (request.edge) {
    if (!specimen.height_field)
      throw UsageError("`specimen.edge`", "the specimen has no height field", "Leave it out");
    specimen.height_field->edge = *request.edge;
  }
  return scene;
}

}  // namespace surf::io
