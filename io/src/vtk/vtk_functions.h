// SPDX-License-Identifier: GPL-3.0-or-later
// What the module `vtk` is made of; image_formats.h and vtp_format.h say what each does.
#pragma once

#include "raster/image_formats.h"
#include "surf/core/volume.h"
#include "vtp_format.h"

namespace surf::io::vtk {

void write_vti(const std::filesystem::path& target, const std::string& file, const Image& image);
std::string vti_content(const std::string& file, const Image& image);
std::string format_vtp(const std::string& file, const SceneView& scene);
std::string format_tracks(const std::string& file, std::span<const Track> tracks,
                          const std::map<std::string, std::string>& metadata);
void write_volume(const std::filesystem::path& target, const std::string& file,
                  const Volume& volume);

}  // namespace surf::io::vtk
