// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "lower_extension.h"
#include "mesh_dispatch.h"
#include "split_mesh.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surface_output.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

std::string file_head(const std::filesystem::path& path, std::size_t bytes) {
  std::ifstream in(path, std::ios::binary);
  std::string head(bytes, '\0');
  in.read(head.data(), static_cast<std::streamsize>(bytes));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

bool may_name_others(MeshFormat format) {
  return format == MeshFormat::gltf || format == MeshFormat::vtm || format == MeshFormat::unknown;
}

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
  if (!may_name_others(mesh_format_of(path, content))) return files;
  content = read_file(path);
  const MeshFormat format = mesh_format_of(path, content);
  if (format == MeshFormat::gltf) {
    for (auto& buffer : gltf_buffer_files(path, content)) files.push_back(std::move(buffer));
  } else if (format == MeshFormat::vtm) {
    for (auto& part : vtm_part_files(path, content)) files.push_back(std::move(part));
  }
  return files;
}

std::vector<std::filesystem::path> write_mesh(const std::filesystem::path& path,
                                              const TriangleMesh& mesh, double unit_nm) {
  const SurfaceFormat& format = surface_format_of(path);
  check_unit(unit_nm, path.string());
  validate(mesh, path.string().c_str());
  const std::string name = path.stem().string();
  if (!has_view_writer(format)) {
    SurfaceScene one;
    one.surfaces.push_back({name, mesh, {}, {}});
    return write_surfaces(path, one, {.factor = mm_nm / unit_nm});
  }
  SceneView scene;
  scene.surfaces.push_back({.name = name, .mesh = &mesh, .scalars = {}});
  if (format.magnified) set_magnification(scene.note, mm_nm / unit_nm);
  scene.note.unit_nm = unit_nm;
  return write_view(path, std::move(scene));
}

void check_mesh_target(const std::filesystem::path& path) { check_surface_target(path); }

bool is_mesh_file(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 9> known{".stl",  ".obj", ".ply", ".off", ".glb",
                                                         ".gltf", ".3mf", ".vtp", ".vtm"};
  return std::find(known.begin(), known.end(), lower_extension(path)) != known.end();
}

bool has_mesh_content(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) &&
         mesh_format_of({}, read_file(path)) != MeshFormat::unknown;
}

}  // namespace surf::io
