// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "mesh_formats.h"
#include "mesh_output.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

TriangleMesh parse(const std::filesystem::path& path, std::string_view content) {
  const std::string file = path.string();
  const std::string extension = lower_extension(path);
  if (content.empty()) {
    throw FileError(file, "the file is empty", "Export the mesh again");
  }
  if (is_ply(content)) return parse_ply(file, content);
  if (is_off(content)) return parse_off(file, content);
  if (is_binary_stl(content) || is_text_stl(content)) return parse_stl(file, content);
  if (extension == ".stl") return parse_stl(file, content);
  if (extension == ".obj") return parse_obj(file, content);
  if (extension == ".ply") return parse_ply(file, content);
  if (extension == ".off") return parse_off(file, content);
  throw FileError(file, "neither its content nor its name is that of a mesh format known here",
                  "Use STL, OBJ, PLY or OFF");
}

void check_unit(double unit_nm, const std::string& file) {
  if (!(unit_nm > 0) || !std::isfinite(unit_nm)) {
    throw UsageError(file, fmt::format("{} nm cannot be the unit of a mesh", unit_nm),
                     "Give a positive length");
  }
}

void check_known(const std::filesystem::path& path) {
  if (is_mesh_file(path)) return;
  throw UsageError(path.string(),
                   fmt::format("'{}' is not a mesh format known here", path.extension().string()),
                   "Use .stl, .obj, .ply or .off");
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
  return format_off(mesh);
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, double unit_nm) {
  const std::string file = path.string();
  check_unit(unit_nm, file);
  TriangleMesh mesh;
  {
    const std::string content = read_file(path);
    mesh = parse(path, content);
  }
  if (mesh.triangles.empty()) {
    throw FileError(file, "there are no triangles in it",
                    "Export a surface, not points or an empty scene");
  }
  if (unit_nm != 1) transform(mesh, unit_nm, {});
  for (const Vec3& vertex : mesh.vertices_nm) {
    if (!is_finite(vertex)) {
      throw FileError(file, fmt::format("its coordinates are too large for a unit of {} nm",
                                        format_exact(unit_nm)),
                      "Check the unit");
    }
  }
  return merge_equal_vertices(mesh);
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
  return extension == ".stl" || extension == ".obj" || extension == ".ply" || extension == ".off";
}

}  // namespace surf::io
