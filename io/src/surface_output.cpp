// SPDX-License-Identifier: GPL-3.0-or-later
// What is written where: one row per format.
#include "surface_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "image_formats.h"
#include "lower_extension.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/overlaps.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

struct Row {
  SurfaceFormat format;
  bool needs_vtk = false;
  double least = 1e-290;  // below it, numbers lose digits
};

constexpr double least_float32 = 1e-30;

const std::vector<Row>& rows() {
  static const std::vector<Row> table{
      {{".glb", true, true, true, true, true}},
      {{".gltf", true, true, true, true, true}},
      {{".3mf", true, false, false, false, true}},
      {{".stl", false, false, false, false, true}, false, least_float32},
      {{".obj", true, false, true, false, true}},
      {{".ply", false, true, false, false, false}},
      {{".off", false, false, false, false, false}},
      {{".vtp", true, true, false, false, false}, true},
      {{".vtm", true, true, true, true, false}, true},
  };
  return table;
}

std::string known_extensions() {
  std::string list;
  for (const Row& row : rows()) {
    const bool is_last = &row == &rows().back();
    list += fmt::format("{}{}", list.empty() ? "" : is_last ? " or " : ", ", row.format.extension);
  }
  return list;
}

const Row& row_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const auto found = std::find_if(rows().begin(), rows().end(), [&](const Row& row) {
    return row.format.extension == extension;
  });
  if (found == rows().end()) {
    throw UsageError(path.string(),
                     fmt::format("meshes are not written as '{}'", path.extension().string()),
                     fmt::format("Use {}", known_extensions()));
  }
  if (found->needs_vtk) require_vtk(path.string());
  return *found;
}

/// The largest distances from the origin, sideways and up.
struct Reach {
  double sideways = 0;
  double up = 0;

  void add(const Vec3& v) {
    sideways = std::max({sideways, std::abs(v.x), std::abs(v.y)});
    up = std::max(up, std::abs(v.z));
  }
};

/// Coordinates that overflow, or are so small that they lose digits.
void check_numbers(const SceneView& scene, const Row& row, const std::string& file) {
  Reach nm, written;
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Vec3& place : surface.mesh->vertices_nm) {
      const Vec3 v = scene.note.to_file(place);
      if (!is_finite(v)) {
        throw InvalidInput(file,
                           fmt::format("its coordinates are too large for a unit of {} nm",
                                       format_exact(scene.note.unit_nm)),
                           "Use a larger unit, or less magnification");
      }
      nm.add(place);
      written.add(v);
    }
  }
  const auto vanishes = [&](double before, double after) {
    return after < row.least && before >= row.least;
  };
  if (!vanishes(nm.sideways, written.sideways) && !vanishes(nm.up, written.up)) return;
  throw InvalidInput(file,
                     fmt::format("its coordinates are too small for a unit of {} nm",
                                 format_exact(scene.note.unit_nm)),
                     "Use a smaller unit, or more magnification");
}

std::vector<OutputFile> one_file(const std::filesystem::path& path, std::string content) {
  std::vector<OutputFile> files;
  files.push_back({path, std::move(content)});
  return files;
}

std::vector<OutputFile> format(const std::filesystem::path& path, const std::string& extension,
                               const SceneView& scene) {
  const std::string file = path.string();
  if (extension == ".stl") return one_file(path, format_stl(file, scene));
  if (extension == ".obj") return format_obj(path, scene);
  if (extension == ".ply") return one_file(path, format_ply(file, scene));
  if (extension == ".off") return one_file(path, format_off(scene));
  if (extension == ".vtp") return one_file(path, format_vtp(file, scene));
  return format_vtm(path, scene);
}

void write_content(const std::filesystem::path& temporary, const std::string& content) {
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) throw std::runtime_error(std::strerror(errno));
}

void write_in_order(std::span<const OutputFile> files) {
  if (files.empty()) return;
  write_atomically(files.back().path, [&](const std::filesystem::path& temporary) {
    write_content(temporary, files.back().content);
    write_in_order(files.first(files.size() - 1));
  });
}

}  // namespace

const std::vector<SurfaceFormat>& surface_formats() {
  static const std::vector<SurfaceFormat> formats = [] {
    std::vector<SurfaceFormat> list;
    for (const Row& row : rows()) list.push_back(row.format);
    return list;
  }();
  return formats;
}

const SurfaceFormat& surface_format_of(const std::filesystem::path& path) {
  return row_of(path).format;
}

bool has_view_writer(const SurfaceFormat& format) {
  return format.extension != ".glb" && format.extension != ".gltf" && format.extension != ".3mf";
}

std::vector<std::filesystem::path> write_all(std::span<const OutputFile> files) {
  std::vector<std::filesystem::path> names;
  for (const OutputFile& file : files) names.push_back(file.path);
  std::ranges::rotate(names, names.end() - 1);
  refuse_strangers(names.front(), {names.begin() + 1, names.end()});
  write_in_order(files);
  return names;
}

std::vector<std::filesystem::path> write_view(const std::filesystem::path& path, SceneView scene) {
  const Row& row = row_of(path);
  check_numbers(scene, row, path.string());
  scene.note.names.clear();
  if (row.format.several || scene.surfaces.size() == 1) {
    for (const SurfaceView& surface : scene.surfaces) scene.note.names.emplace_back(surface.name);
  }
  return write_all(format(path, row.format.extension, scene));
}

}  // namespace surf::io
