// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_dispatch.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "lower_extension.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

ParsedFile parse_metres(const std::filesystem::path& path, std::string_view content) {
  ParsedFile parsed;
  parsed.note.unit_nm = 1e9;
  for (NamedMesh& found : parse_gltf(path, content)) {
    parsed.bodies.push_back({found.material, {.name = found.name, .mesh = std::move(found.mesh)}});
  }
  return parsed;
}

ParsedFile parse(const std::filesystem::path& path, Want want) {
  const std::string file = path.string();
  const std::string content = read_file(path);
  if (content.empty()) throw FileError(file, "the file is empty", "Export the mesh again");
  switch (mesh_format_of(path, content)) {
    case MeshFormat::stl: return parse_stl(file, content);
    case MeshFormat::obj: return parse_obj(path, content, want);
    case MeshFormat::ply: return parse_ply(file, content, want);
    case MeshFormat::off: return parse_off(file, content);
    case MeshFormat::gltf: return parse_metres(path, content);
    case MeshFormat::vtp: return parse_vtp(file, content, want);
    case MeshFormat::vtm: return parse_vtm(path, content, want);
    case MeshFormat::unknown: break;
  }
  throw FileError(file, "neither its content nor its name is that of a mesh format known here",
                  "Use STL, OBJ, PLY, OFF, glTF, VTP or VTM");
}

void convert_to_nm(TriangleMesh& mesh, const SurfaceNote& note, const std::string& file) {
  if (note.unit_nm == 1 && note.z_exaggeration == 1) return;   // what was read is finite
  for (Vec3& v : mesh.vertices_nm) {
    v = note.to_nm(v);
    if (is_finite(v)) continue;
    throw FileError(file, fmt::format("its coordinates are too large for a unit of {} nm",
                                      format_exact(note.unit_nm)),
                    "Check the unit");
  }
}

}  // namespace

void check_unit(double unit_nm, const std::string& file) {
  if (unit_nm > 0 && std::isfinite(unit_nm)) return;
  throw UsageError(file, fmt::format("{} nm cannot be the unit of a mesh", unit_nm), "Give a positive length");
}

MeshFormat mesh_format_of(const std::filesystem::path& path, std::string_view content) {
  if (is_glb(content)) return MeshFormat::gltf;
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
  if (extension == ".vtp") return MeshFormat::vtp;
  if (extension == ".vtm") return MeshFormat::vtm;
  return MeshFormat::unknown;
}

ParsedFile parse_mesh_file(const std::filesystem::path& path, std::optional<double> unit_nm, Want want) {
  const std::string file = path.string();
  if (unit_nm) check_unit(*unit_nm, file);
  ParsedFile parsed = parse(path, want);
  if (unit_nm) parsed.note.unit_nm = *unit_nm;
  std::erase_if(parsed.bodies, [](const ParsedBody& body) { return body.surface.mesh.triangles.empty(); });
  if (parsed.bodies.empty()) {
    throw FileError(file, "there are no triangles in it", "Export a surface, not points or an empty scene");
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
