// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_dispatch.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "file_unit.h"
#include "lower_extension.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surface_formats.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

/// glTF's shapes alone, with their materials.
ParsedFile parse_gltf_shapes(const std::filesystem::path& path, std::string_view content) {
  ParsedFile parsed;
  GltfMeshes found = parse_gltf(path, content);
  parsed.note.unit_nm = found.unit_nm;
  parsed.note.states_unit = true;
  for (NamedMesh& body : found.meshes) {
    parsed.bodies.push_back(
        {std::move(body.material), {.name = std::move(body.name), .mesh = std::move(body.mesh)}});
  }
  return parsed;
}

/// A scene that is in nm already.
ParsedFile in_nm(SurfaceScene scene) {
  ParsedFile parsed;
  for (Surface& surface : scene.surfaces) parsed.bodies.push_back({{}, std::move(surface)});
  parsed.tracks = std::move(scene.tracks);
  parsed.note.metadata = std::move(scene.metadata);
  return parsed;
}

ParsedFile with_unit(ParsedFile parsed, const MeshUnit& unit, const std::string& file) {
  const auto stated_nm =
      parsed.note.states_unit ? std::optional(parsed.note.unit_nm) : std::nullopt;
  parsed.unit_assumed = !unit.nm && !stated_nm;
  parsed.note.unit_nm = file_unit_nm(unit, stated_nm, file);
  return parsed;
}

ParsedFile parse(const std::filesystem::path& path, const MeshUnit& unit, Want want) {
  const std::string file = path.string();
  const std::string content = read_file(path);
  if (content.empty()) throw FileError(file, "the file is empty", "Export the mesh again");
  switch (mesh_format_of(path, content)) {
    case MeshFormat::stl:
      return with_unit(parse_stl(file, content), unit, file);
    case MeshFormat::obj:
      return with_unit(parse_obj(path, content, want), unit, file);
    case MeshFormat::ply:
      return with_unit(parse_ply(file, content, want), unit, file);
    case MeshFormat::off:
      return with_unit(parse_off(file, content), unit, file);
    case MeshFormat::gltf:
      if (want == Want::shapes) return with_unit(parse_gltf_shapes(path, content), unit, file);
      return in_nm(parse_gltf_scene(path, content, unit));
    case MeshFormat::three_mf:
      return in_nm(parse_3mf_scene(path, content, unit));
    case MeshFormat::vtp:
      return with_unit(parse_vtp(file, content, want), unit, file);
    case MeshFormat::vtm:
      return with_unit(parse_vtm(path, content, want), unit, file);
    case MeshFormat::unknown:
      break;
  }
  throw FileError(file, "neither its content nor its name is that of a mesh format known here",
                  "Use STL, OBJ, PLY, OFF, glTF, 3MF, VTP or VTM");
}

void convert_to_nm(TriangleMesh& mesh, const SurfaceNote& note, const std::string& file) {
  if (note.unit_nm == 1 && note.z_exaggeration == 1) return;  // what was read is finite
  for (Vec3& v : mesh.vertices_nm) {
    v = note.to_nm(v);
    if (is_finite(v)) continue;
    throw FileError(file,
                    fmt::format("its coordinates are too large for a unit of {} nm",
                                format_exact(note.unit_nm)),
                    "Check the unit");
  }
}

}  // namespace

void check_unit(double unit_nm, const std::string& file) {
  if (unit_nm > 0 && std::isfinite(unit_nm)) return;
  throw UsageError(file, fmt::format("{} nm cannot be the unit of a mesh", unit_nm),
                   "Give a positive length");
}

MeshFormat mesh_format_of(const std::filesystem::path& path, std::string_view content) {
  if (is_glb(content)) return MeshFormat::gltf;
  if (is_3mf(content)) return MeshFormat::three_mf;
  if (is_vtm(content)) return MeshFormat::vtm;
  if (is_vtp(content)) return MeshFormat::vtp;
  if (is_ply(content)) return MeshFormat::ply;
  if (is_off(content)) return MeshFormat::off;
  if (is_binary_stl(content) || is_text_stl(content)) return MeshFormat::stl;
  const std::string extension = lower_extension(path);
  if (extension == ".stl") return MeshFormat::stl;
  if (extension == ".obj") return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".off") return MeshFormat::off;
  if (extension == ".glb" || extension == ".gltf") return MeshFormat::gltf;
  if (extension == ".3mf") return MeshFormat::three_mf;
  if (extension == ".vtp") return MeshFormat::vtp;
  if (extension == ".vtm") return MeshFormat::vtm;
  return MeshFormat::unknown;
}

ParsedFile parse_mesh_file(const std::filesystem::path& path, const MeshUnit& unit, Want want) {
  const std::string file = path.string();
  if (unit.nm) check_unit(*unit.nm, file);
  ParsedFile parsed = parse(path, unit, want);
  std::erase_if(parsed.bodies,
                [](const ParsedBody& body) { return body.surface.mesh.triangles.empty(); });
  if (parsed.bodies.empty()) {
    throw FileError(file, "there are no triangles in it",
                    "Export a surface, not points or an empty scene");
  }
  const bool has_names = parsed.note.names.size() == parsed.bodies.size();
  for (std::size_t i = 0; i < parsed.bodies.size(); ++i) {
    Surface& surface = parsed.bodies[i].surface;
    if (has_names) surface.name = parsed.note.names[i];
    if (surface.name.empty()) surface.name = path.stem().string();
    convert_to_nm(surface.mesh, parsed.note, file);
  }
  return parsed;
}

}  // namespace surf::io
