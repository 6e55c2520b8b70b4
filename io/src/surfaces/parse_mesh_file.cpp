// SPDX-License-Identifier: GPL-3.0-or-later
#include "parse_mesh_file.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "known_formats.h"
#include "mesh/file_unit.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

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
  const MeshFormat* format = format_of(path, content);
  if (!format)
    throw FileError(file, "neither its content nor its name is that of a mesh format known here",
                    "Use STL, OBJ, PLY, OFF, glTF, 3MF, VTP or VTM");
  ParsedFile parsed = format->parse({path, content, unit, want});
  return parsed.is_in_nm ? parsed : with_unit(std::move(parsed), unit, file);
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
