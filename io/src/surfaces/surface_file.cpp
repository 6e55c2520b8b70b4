// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/surface_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/surface_names.h"
#include "parse_mesh_file.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/overlaps.h"
#include "surface_output.h"

namespace surf::io {
namespace {

void check_magnification(const Magnification& magnification, const std::string& file) {
  const auto check = [&](double value, const char* what) {
    if (value > 0 && std::isfinite(value)) return;
    throw UsageError(file, fmt::format("{} cannot be a {}", value, what), "Give a positive number");
  };
  check(magnification.factor, "magnification");
  check(mm_nm / magnification.factor, "unit in nm, which the magnification leads to");
  check(magnification.z_exaggeration, "z exaggeration");
}

void tidy_scalars(Surface& surface) {
  std::erase_if(surface.scalars, [](const VertexScalar& scalar) {
    return !std::all_of(scalar.values.begin(), scalar.values.end(),
                        [](float v) { return std::isfinite(v); });
  });
  UniqueNames unique("_");
  for (VertexScalar& scalar : surface.scalars) scalar.name = unique(scalar_name(scalar.name));
}

}  // namespace

const SurfaceFormat& check_surface_target(const std::filesystem::path& path) {
  const SurfaceFormat& form = *written_format(path).form;
  const std::vector<std::filesystem::path> files = files_written_with(path);
  refuse_strangers(path, {files.begin() + 1, files.end()});
  check_writable(path);
  return form;
}

std::vector<std::filesystem::path> write_surfaces(const std::filesystem::path& path,
                                                  const SurfaceScene& scene,
                                                  const Magnification& magnification) {
  const SurfaceFormat& form = *written_format(path).form;
  check_magnification(magnification, path.string());
  validate(scene, path.string().c_str());
  SceneView view = view_of(scene);
  if (form.magnified) set_magnification(view.note, magnification);
  return write_view(path, std::move(view));
}

SurfaceScene read_surfaces(const std::filesystem::path& path, const MeshUnit& unit) {
  ParsedFile parsed = parse_mesh_file(path, unit, Want::everything);
  SurfaceScene scene;
  UniqueNames unique;
  for (ParsedBody& body : parsed.bodies) {
    Surface& surface = body.surface;
    surface.name = unique(surface.name);
    tidy_scalars(surface);
    scene.surfaces.push_back(std::move(surface));
  }
  scene.tracks = std::move(parsed.tracks);
  scene.metadata = std::move(parsed.note.metadata);
  return scene;
}

}  // namespace surf::io
