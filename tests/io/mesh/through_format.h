// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/mesh_format.h"

namespace surf::test {

/// The files that a format makes of a scene.
inline std::vector<io::OutputFile> formatted(const io::MeshFormat& format,
                                             const std::filesystem::path& path,
                                             const SurfaceScene& scene,
                                             const io::Magnification& magnification = {}) {
  io::SceneView view = io::view_of(scene);
  set_magnification(view.note, magnification);
  return format.format(path, view);
}

/// What a format that converts to nm reads.
inline SurfaceScene parsed(const io::MeshFormat& format, const std::filesystem::path& path,
                           std::string_view content, const io::MeshUnit& unit = {}) {
  io::ParsedFile file = format.parse({path, content, unit, io::Want::everything});
  SurfaceScene scene;
  for (io::ParsedBody& body : file.bodies) scene.surfaces.push_back(std::move(body.surface));
  scene.tracks = std::move(file.tracks);
  scene.metadata = std::move(file.note.metadata);
  return scene;
}

}  // namespace surf::test
