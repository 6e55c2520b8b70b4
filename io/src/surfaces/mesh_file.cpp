// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_file.h"

#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "known_formats.h"
#include "mesh/file_unit.h"
#include "mesh/split_mesh.h"
#include "parse_mesh_file.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surface_output.h"

namespace surf::io {
namespace {

std::string file_head(const std::filesystem::path& path, std::size_t bytes) {
  std::ifstream in(path, std::ios::binary);
  std::string head(bytes, '\0');
  in.read(head.data(), static_cast<std::streamsize>(bytes));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

bool may_name_others(const MeshFormat* format) { return !format || format->named_files; }

}  // namespace

std::vector<NamedMesh> read_meshes(const std::filesystem::path& path, const MeshUnit& unit) {
  std::vector<NamedMesh> meshes;
  ParsedFile parsed = parse_mesh_file(path, unit, Want::shapes);
  for (ParsedBody& body : parsed.bodies) {
    Surface& surface = body.surface;
    meshes.push_back({std::move(surface.name), std::move(body.material),
                      merge_equal_vertices(surface.mesh), parsed.unit_assumed});
    surface.mesh = {};  // two copies of one body at a time
  }
  return meshes;
}

TriangleMesh join(const std::vector<NamedMesh>& meshes) {
  TriangleMesh all;
  for (const NamedMesh& part : meshes) append(all, part.mesh);
  return merge_equal_vertices(all);
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshUnit& unit) {
  std::vector<NamedMesh> meshes = read_meshes(path, unit);
  if (meshes.size() == 1) return std::move(meshes.front().mesh);
  return join(meshes);
}

std::vector<std::filesystem::path> mesh_input_files(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error))
    require_regular_file(path);  // its reader says that it is missing
  std::vector<std::filesystem::path> files{path};
  // Only files that name others are read whole, and few of those are large.
  std::string content = file_head(path, 65536);
  if (!may_name_others(format_of(path, content))) return files;
  content = read_file(path);
  const MeshFormat* format = format_of(path, content);
  if (!format || !format->named_files) return files;
  for (auto& named : format->named_files(path, content)) files.push_back(std::move(named));
  return files;
}

std::vector<std::filesystem::path> write_mesh(const std::filesystem::path& path,
                                              const TriangleMesh& mesh, double unit_nm) {
  const SurfaceFormat& form = *written_format(path).form;
  check_unit(unit_nm, path.string());
  validate(mesh, path.string().c_str());
  const std::string name = path.stem().string();
  SceneView scene;
  scene.surfaces.push_back({.name = name, .mesh = &mesh, .scalars = {}});
  if (form.magnified) set_magnification(scene.note, mm_nm / unit_nm);
  scene.note.unit_nm = unit_nm;
  return write_view(path, std::move(scene));
}

void check_mesh_target(const std::filesystem::path& path) { check_surface_target(path); }

bool is_mesh_file(const std::filesystem::path& path) { return format_named(path).format; }

bool has_mesh_content(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && format_of({}, read_file(path));
}

}  // namespace surf::io
