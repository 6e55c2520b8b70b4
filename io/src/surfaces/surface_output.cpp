// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/overlaps.h"

namespace surf::io {
namespace {

std::string known_extensions() {
  std::string list;
  for (const SurfaceFormat& form : surface_formats()) {
    const bool is_last = &form == &surface_formats().back();
    list += fmt::format("{}{}", list.empty() ? "" : is_last ? " or " : ", ", form.extension);
  }
  return list;
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
void check_numbers(const SceneView& scene, double least, const std::string& file) {
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
    return after < least && before >= least;
  };
  if (!vanishes(nm.sideways, written.sideways) && !vanishes(nm.up, written.up)) return;
  throw InvalidInput(file,
                     fmt::format("its coordinates are too small for a unit of {} nm",
                                 format_exact(scene.note.unit_nm)),
                     "Use a smaller unit, or more magnification");
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
  static const std::vector<SurfaceFormat> all = [] {
    std::vector<SurfaceFormat> list;
    for (const MeshFormat* format : known_formats())
      list.insert(list.end(), format->forms.begin(), format->forms.end());
    return list;
  }();
  return all;
}

NamedFormat written_format(const std::filesystem::path& path) {
  const NamedFormat found = format_named(path);
  if (!found.format) {
    throw UsageError(path.string(),
                     fmt::format("meshes are not written as '{}'", path.extension().string()),
                     fmt::format("Use {}", known_extensions()));
  }
  if (found.format->needs_vtk) require_vtk(path.string());
  return found;
}

std::vector<std::filesystem::path> write_view(const std::filesystem::path& path, SceneView scene) {
  const auto [format, form] = written_format(path);
  if (format->least > 0) check_numbers(scene, format->least, path.string());
  scene.note.names.clear();
  if (form->several || scene.surfaces.size() == 1) {
    for (const SurfaceView& surface : scene.surfaces) scene.note.names.emplace_back(surface.name);
  }
  const std::vector<OutputFile> files = format->format(path, scene);
  std::vector<std::filesystem::path> names;
  for (const OutputFile& file : files) names.push_back(file.path);
  std::rotate(names.begin(), names.end() - 1, names.end());
  refuse_strangers(names.front(), {names.begin() + 1, names.end()});
  write_in_order(files);
  return names;
}

}  // namespace surf::io
