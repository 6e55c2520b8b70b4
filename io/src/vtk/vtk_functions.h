// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the module `vtk`, documented in image_formats.h and vtp_format.h.
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
