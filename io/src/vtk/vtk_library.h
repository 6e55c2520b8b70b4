// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "raster/image_formats.h"
#include "surf/core/module.h"
#include "surf/core/volume.h"
#include "vtp_format.h"

namespace surf::io {

/// The function table of the module `vtk`. Files of VTK are read without it.
struct VtkLibrary {
  static constexpr ModuleName module{"vtk", "writes VTI, VTP and VTM files",
                                     "VTK (Debian: paraview or libvtk9.1, as it was built with)",
                                     100, "semsurf-io-vtk"};

  decltype(&io::write_vti) write_vti;
  decltype(&io::vti_content) vti_content;
  decltype(&io::format_vtp) format_vtp;
  decltype(&io::format_tracks) format_tracks;
  void (*write_volume)(const std::filesystem::path& target, const std::string& file,
                       const Volume& volume);
};

/// Throws Unsupported, naming `file`, if the module is missing.
const VtkLibrary& vtk_library(const std::string& file);

}  // namespace surf::io
