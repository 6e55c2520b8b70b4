// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_file.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "lower_extension.h"
#include "mesh_formats.h"
#include "mesh_output.h"
#include "split_mesh.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surface_formats.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

enum class Format { stl, obj, ply, off, gltf, vtp, three_mf, unknown };

/// By content where that is telling, else by name.
Format format_of(const std::filesystem::path& path, std::string_view content) {
  if (is_glb(content)) return Format::gltf;
  if (is_vtp(content)) return Format::vtp;
  if (is_3mf(content)) return Format::three_mf;
  if (is_ply(content)) return Format::ply;
  if (is_off(content)) return Format::off;
  if (is_binary_stl(content) || is_text_stl(content)) return Format::stl;
  const std::string extension = lower_extension(path);
  if (extension == ".stl") return Format::stl;
  if (extension == ".obj") return Format::obj;
  if (extension == ".ply") return Format::ply;
  if (extension == ".off") return Format::off;
  if (extension == ".glb" || extension == ".gltf") return Format::gltf;
  if (extension == ".vtp") return Format::vtp;
  if (extension == ".3mf") return Format::three_mf;
  return Format::unknown;
}

/// The meshes in file units, and the nm of one unit where the format says it.
struct Parsed {
  std::vector<NamedMesh> meshes;
  double unit_nm = 1;
};

/// In nm, or in units of `unit_nm`.
std::vector<NamedMesh> parse_3mf(const std::filesystem::path& path, std::string_view content,
                                 std::optional<double> unit_nm) {
  std::vector<NamedMesh> meshes;
  for (Surface& surface : parse_3mf_scene(path, content, unit_nm ? std::optional(1.0) : std::nullopt).surfaces) {
    meshes.push_back({std::move(surface.name), {}, std::move(surface.mesh)});
  }
  return meshes;
}

Parsed parse(const std::filesystem::path& path, std::optional<double> unit_nm) {
  const std::string file = path.string();
  const std::string content = read_file(path);
  if (content.empty()) throw FileError(file, "the file is empty", "Export the mesh again");
  switch (format_of(path, content)) {
    case Format::stl: return {{{{}, {}, parse_stl(file, content)}}};
    case Format::obj: return {parse_obj(file, content)};
    case Format::ply: return {{{{}, {}, parse_ply(file, content)}}};
    case Format::off: return {{{{}, {}, parse_off(file, content)}}};
    case Format::gltf: {
      GltfMeshes found = parse_gltf(path, content);
      return {std::move(found.meshes), found.unit_nm};
    }
    case Format::vtp: return {parse_vtp(file, content)};
    case Format::three_mf: return {parse_3mf(path, content, unit_nm)};
    case Format::unknown: break;
  }
  throw FileError(file, "neither its content nor its name is that of a mesh format known here",
                  "Use STL, OBJ, PLY, OFF, glTF, 3MF or VTP");
}

void check_unit(double unit_nm, const std::string& file) {
  if (!(unit_nm > 0) || !std::isfinite(unit_nm)) {
    throw UsageError(file, fmt::format("{} nm cannot be the unit of a mesh", unit_nm),
                     "Give a positive length");
  }
}

bool is_writable_format(const std::string& extension) {
  return extension == ".stl" || extension == ".obj" || extension == ".ply" ||
         extension == ".off" || extension == ".vtp";
}

void check_known(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (!is_writable_format(extension)) {
    throw UsageError(path.string(),
                     fmt::format("meshes are not written as '{}'", path.extension().string()),
                     "Use .stl, .obj, .ply, .off or .vtp");
  }
  if (extension == ".vtp" && !has_vtp_writer()) {
    throw Unsupported(path.string(), "this semsurf was built without VTK, which writes VTP",
                      "Use .ply, or build with VTK");
  }
}

void check_finite(const TriangleMesh& mesh, double unit_nm, const std::string& file) {
  for (const Vec3& vertex : mesh.vertices_nm) {
    if (is_finite(vertex)) continue;
    throw FileError(file, fmt::format("its coordinates are too large for a unit of {} nm",
                                      format_exact(unit_nm)),
                    "Check the unit");
  }
}

TriangleMesh in_file_units(TriangleMesh mesh, double unit_nm, const std::string& file) {
  if (unit_nm == 1) return mesh;
  for (Vec3& v : mesh.vertices_nm) {
    v = {v.x / unit_nm, v.y / unit_nm, v.z / unit_nm};
    if (is_finite(v)) continue;
    throw InvalidInput(file, fmt::format("its coordinates are too large for a unit of {} nm",
                                         format_exact(unit_nm)),
                       "Use a larger unit");
  }
  return mesh;
}

std::string format_mesh(const std::string& file, const std::string& extension,
                        const TriangleMesh& mesh) {
  if (extension == ".stl") return format_stl(file, mesh);
  if (extension == ".obj") return format_obj(mesh);
  if (extension == ".ply") return format_ply(file, mesh);
  if (extension == ".vtp") return format_vtp(file, mesh);
  return format_off(mesh);
}

}  // namespace

std::vector<NamedMesh> read_meshes(const std::filesystem::path& path,
                                   std::optional<double> unit_nm) {
  const std::string file = path.string();
  if (unit_nm) check_unit(*unit_nm, file);
  Parsed parsed = parse(path, unit_nm);
  const double unit = unit_nm.value_or(parsed.unit_nm);
  std::vector<NamedMesh> meshes;
  for (NamedMesh& found : parsed.meshes) {
    if (found.mesh.triangles.empty()) continue;
    if (found.name.empty()) found.name = path.stem().string();
    if (unit != 1) transform(found.mesh, unit, {});
    check_finite(found.mesh, unit, file);
    meshes.push_back({found.name, found.material, merge_equal_vertices(found.mesh)});
  }
  if (meshes.empty()) {
    throw FileError(file, "there are no triangles in it",
                    "Export a surface, not points or an empty scene");
  }
  return meshes;
}

TriangleMesh join(const std::vector<NamedMesh>& meshes) {
  TriangleMesh all;
  for (const NamedMesh& part : meshes) append(all, part.mesh);
  return merge_equal_vertices(all);
}

TriangleMesh read_mesh(const std::filesystem::path& path, std::optional<double> unit_nm) {
  std::vector<NamedMesh> meshes = read_meshes(path, unit_nm);
  if (meshes.size() == 1) return std::move(meshes.front().mesh);
  return join(meshes);
}

std::vector<std::filesystem::path> mesh_input_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files{path};
  const std::string content = read_file(path);
  if (format_of(path, content) == Format::gltf) {
    for (auto& buffer : gltf_buffer_files(path, content)) files.push_back(std::move(buffer));
  }
  return files;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, double unit_nm) {
  const std::string file = path.string();
  check_known(path);
  check_unit(unit_nm, file);
  validate(mesh, file.c_str());
  write_text(path, format_mesh(file, lower_extension(path), in_file_units(mesh, unit_nm, file)));
}

void check_mesh_target(const std::filesystem::path& path) {
  check_known(path);
  check_writable(path);
}

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return is_writable_format(extension) || extension == ".glb" || extension == ".gltf" ||
         extension == ".3mf";
}

}  // namespace surf::io
