// SPDX-License-Identifier: GPL-3.0-or-later
// VTI and VTP by the module `vtk`.
#include "vtk_library.h"

#include "files/module_for.h"

namespace surf::io {

const VtkLibrary& vtk_library(const std::string& file) { return module_for<VtkLibrary>(file); }

void require_vtk(const std::string& file) { vtk_library(file); }

void write_vti(const std::filesystem::path& target, const std::string& file, const Image& image) {
  vtk_library(file).write_vti(target, file, image);
}

std::string vti_content(const std::string& file, const Image& image) {
  return vtk_library(file).vti_content(file, image);
}

std::string format_vtp(const std::string& file, const SceneView& scene) {
  return vtk_library(file).format_vtp(file, scene);
}

std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata) {
  return vtk_library(file).format_tracks(file, tracks, metadata);
}

}  // namespace surf::io
